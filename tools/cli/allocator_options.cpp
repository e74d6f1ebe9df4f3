// SPDX-License-Identifier: GPL-3.0-or-later
// Options of jemalloc, which reads them from this name.
#include <jemalloc/jemalloc.h>

extern "C" {

// Commands write each page of their memory once or twice, and the first touch of one costs a fault: huge pages save 511
// of 512 of them. What was freed goes back to the system after some 0.2 s, not 10: reading a map frees what was read of
// its file on the way. MALLOC_CONF in the environment comes after these and wins.
const char* malloc_conf = "thp:always,metadata_thp:auto,dirty_decay_ms:200";
}
