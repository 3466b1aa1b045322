// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/loaders.hpp"

namespace isotet::io::confined {

Load loader_of(std::string_view format) {
    struct Named {
        std::string_view format;
        Load load;
    };
    static constexpr Named loaders[] = {
        {"exodus", load_exodus}, {"cgns", load_cgns}, {"vtkhdf", load_vtkhdf},
        {"med", load_med},       {"xdmf", load_xdmf}, {"ensight", load_ensight},
    };
    for (const Named& named : loaders) {
        if (named.format == format) return named.load;
    }
    return nullptr;
}

} // namespace isotet::io::confined
