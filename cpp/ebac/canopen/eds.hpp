#pragma once

#include <string>

#include "ebac/canopen/object_dictionary.hpp"

namespace ebac::can {

/// The electronic data sheet (CiA 306) of a drive, of all that it serves and with its own defaults;
/// identifiers that depend on the node stand as $NODEID.
std::string eds(const ObjectDictionary& objects);

}  // namespace ebac::can
