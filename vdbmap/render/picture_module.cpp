// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/picture_module.h"

#include "vdbmap/io/file/module.h"

namespace vdbmap {

const PictureModule& picture_module() {
  static const PictureModule& module =
      *load_module<PictureModule>("vdbmap_pictures.so", "vdbmap_picture_module", "what draws pictures");
  return module;
}

}  // namespace vdbmap
