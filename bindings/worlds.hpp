#pragma once

#include <memory>
#include <utility>

#include "ebac/model/environment.hpp"

namespace ebac::python {

/// A world as Python holds it: the setup that is given one keeps it for as long as it needs it.
struct HeldWorld : External {
  explicit HeldWorld(std::unique_ptr<World> made) : External{made.get()}, held(std::move(made)) {}
  std::shared_ptr<World> held;
};

}  // namespace ebac::python
