#pragma once

#include <memory>

#include "ebac/model/contact_force.hpp"

namespace ebac {

/// A virtual world of any kind, called from the tick: where the handle is and how fast, in; what it meets, out.
///
/// A world may keep a memory from one call to the next. Each run has a copy of its own.
class World {
 public:
  virtual ~World() = default;

  /// At position `x` [m], velocity `v` [m/s] and time `t` [s] of the run. Never throws, blocks or allocates.
  virtual ContactForce contact(const Axes& x, const Axes& v, double t) EBAC_RT = 0;

  /// Elastic energy of what the last `contact` met [J]: what it would give back to a hand that leaves slowly.
  virtual double stored() const EBAC_RT { return 0; }

  /// The same world without memory, for another run.
  virtual std::unique_ptr<World> fresh() const = 0;

 protected:
  World() = default;
  World(const World&) = default;
  World& operator=(const World&) = default;
};

}  // namespace ebac
