// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Marks what isotet's shared libraries show: what public headers declare, and what the libraries need of each other.
/// All else is hidden.
#define ISOTET_API __attribute__((visibility("default")))
