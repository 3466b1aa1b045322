// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The program isotet-reader, which isotet starts to read formats that VTK reads.
#include "io/confined/serve.hpp"

int main() { return isotet::io::confined::serve(); }
