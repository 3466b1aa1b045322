// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <isotet/read.hpp>

isotet::ReaderConfinement isotet::reader_confinement() {
    ReaderConfinement result;
    result.files = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) >= 1;
#if defined(__x86_64__) || defined(__aarch64__)
    const unsigned action = SECCOMP_RET_ERRNO;
    result.calls = ::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
#endif
    return result;
}
