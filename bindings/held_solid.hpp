#pragma once

#include "ebac/world/combined.hpp"

namespace ebac::python {

/// A solid as Python holds it.
struct HeldSolid {
  world::SolidPtr solid;
};

}  // namespace ebac::python
