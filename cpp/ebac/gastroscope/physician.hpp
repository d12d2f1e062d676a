#pragma once

#include <cstdint>
#include <vector>

#include "ebac/gastroscope/master.hpp"
#include "ebac/gastroscope/slave.hpp"
#include "ebac/gastroscope/task.hpp"
#include "ebac/model/noise.hpp"

namespace ebac::gastroscope {

/// One picture: where the goal is in it, and what else a physician sees of the way.
struct View {
  double right = 0;  // rad, bearing of the goal
  double down = 0;   // rad
  double gap = 1;    // m, before the wall
  double place = 0;  // m, along the lumen
  bool touches = false;
};

/// What the hand wants.
struct Wish {
  Handle aim{};      // m, of the handle
  double pedal = 0;  // m/s
  bool clutched = true;
};

/// Steers the gastroscope from the teeth to the pylorus and touches targets on the way: looks along
/// the lumen or at a target, turns towards it, and advances where the way is clear.
class Physician {
 public:
  enum class Phase : int { kGo, kAim, kBack, kDone };

  Physician(const PhysicianParams& params, const MasterParams& master, const Lumen& lumen,
            std::vector<Target> targets, std::uint64_t seed, double dt);

  /// One tick: the slave as it is (its picture comes later), the handle's place [m] and the force on
  /// the hand [N].
  Wish step(const Slave& slave, const Handle& x, const Handle& force, double t) EBAC_RT;

  Phase phase() const EBAC_RT { return phase_; }
  std::size_t touched() const EBAC_RT { return touched_; }
  /// Where a target is now [m].
  Vec target_at(std::size_t i, const LumenMotion& motion) const EBAC_RT;
  const View& seen() const EBAC_RT { return seen_; }

 private:
  View look(const Slave& slave) EBAC_RT;
  bool touches(const Slave& slave) const EBAC_RT;
  void decide(double t) EBAC_RT;
  void change(Phase phase, double t) EBAC_RT;
  double speed(double off, double felt) const EBAC_RT;
  void turn(const Handle& x) EBAC_RT;
  void insert(double speed, const Handle& x) EBAC_RT;

  static constexpr double kPicture = 1.0 / 30;  // s
  static constexpr double kReach = 8e-3;        // m, of a touch

  PhysicianParams params_;
  MasterParams master_;
  const Lumen* lumen_;
  std::vector<Target> targets_;
  Noise random_;
  double dt_, gain_;
  int every_, until_ = 0;
  DelayLine<View> pictures_;
  DelayLine<double> feels_;
  View now_{}, seen_{};
  Phase phase_ = Phase::kGo;
  double since_ = 0;  // s
  std::size_t next_ = 0, touched_ = 0;
  Wish wish_{};
};

}  // namespace ebac::gastroscope
