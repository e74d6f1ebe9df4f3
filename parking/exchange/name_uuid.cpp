// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/exchange/name_uuid.h"

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>

namespace vdbmap::parking {

std::string uuid_of_name(const std::string& name) {
  return boost::uuids::to_string(boost::uuids::name_generator_sha1(boost::uuids::ns::url())(name));
}

}  // namespace vdbmap::parking
