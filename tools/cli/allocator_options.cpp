// SPDX-License-Identifier: GPL-3.0-or-later
// Options of jemalloc, which reads them from this name.
#include <jemalloc/jemalloc.h>

extern "C" {

// Commands write each page of their memory once or twice, and the first touch of one costs a fault: huge pages save 511
// of 512 of them. MALLOC_CONF in the environment comes after these and wins.
const char* malloc_conf = "thp:always,metadata_thp:auto";
}
