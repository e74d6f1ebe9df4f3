// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the hash of the sample maps. Compiled, with all of the library's code that it runs, for processors without AVX
// and fused multiplication: see portable_bytes_test.cpp.
#include <cstdio>

#include "tests/portable/sample_hash.h"

int main() { std::printf("%016llx\n", static_cast<unsigned long long>(vdbmap::portable::sample_hash())); }
