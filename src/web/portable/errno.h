// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// <errno.h> of a C library that was built without threads: they share its errno.
#pragma once
#ifdef ISOTET_WEB_WORKERS
#define thread_local
#endif
#include_next <errno.h>
#ifdef ISOTET_WEB_WORKERS
#undef thread_local
#endif
