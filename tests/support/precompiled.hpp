// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Compiled once for all kinds of test.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/read.hpp>
