#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "ebac/gastroscope/slave.hpp"
#include "ebac/sim/with_machine.hpp"

namespace ebac::gastroscope {

/// What a cable at the drum of a drive moves, in the order of the slave's axes.
struct Gears {
  double insertion = 1;         // m/m
  double rotation = 1 / 15e-3;  // rad/m
  double bend = 1 / 15e-3;      // rad/m

  std::array<double, 4> each() const EBAC_RT { return {insertion, rotation, bend, bend}; }

  static constexpr auto fields() {
    using F = Field<Gears>;
    return std::array{
        F{"insertion", &Gears::insertion, "1", "insertion per way of its cable", 0.01, 100},
        F{"rotation", &Gears::rotation, "rad/m", "rotation per way of its cable", 0.1, 1e4},
        F{"bend", &Gears::bend, "rad/m", "bend per way of its cable", 0.1, 1e4},
    };
  }
};

/// What the scope behind the drives has met.
struct ScopeReport {
  double seconds = 0;       // s
  double place = 0;         // m
  double inserted = 0;      // m
  double tip = 0;           // N
  double most_section = 0;  // N
  double most_tube = 0;     // N

  static constexpr auto fields() {
    using F = Field<ScopeReport>;
    return std::array{
        F{"seconds", &ScopeReport::seconds, "s", "that it moved"},
        F{"place", &ScopeReport::place, "m", "of the camera along the lumen"},
        F{"inserted", &ScopeReport::inserted, "m", "length behind the teeth"},
        F{"tip", &ScopeReport::tip, "N", "of the wall on the camera now"},
        F{"most_section", &ScopeReport::most_section, "N",
          "largest force of the wall on a point of the bending section or the camera"},
        F{"most_tube", &ScopeReport::most_tube, "N",
          "largest force of the wall on a place of the tube"},
    };
  }
};

/// The gastroscope in the patient behind the simulated drives of its four axes: tendons, tube, wall. The drives are in two
/// groups, insertion and rotation, and both bends, each with a thread of its own; the first one moves the scope. Time that
/// the drives missed is not made up for: as for can::PatientPlant, and as the clock of a loop skips ticks, it stands still
/// beyond the longest step.
class DrivenScope {
 public:
  DrivenScope(const ScopeParams& scope, std::shared_ptr<const Lumen> lumen, double start,
              const Gears& gears);

  /// What the drives of group 0 or 1 move; keeps the scope alive.
  static std::shared_ptr<DrivenMachine> load(std::shared_ptr<DrivenScope> scope, std::size_t group);
  /// As of the last tick; from any thread.
  ScopeReport report() const;

  std::array<double, kMaxAxes> meet(std::size_t group, const std::array<double, kMaxAxes>& x,
                                    double elapsed) EBAC_RT;

 private:
  static constexpr double kStep = 2e-3;    // s, longest that is computed at once
  static constexpr double kLongest = 0.2;  // s, of one `meet`: twice the longest sample time

  void move(double elapsed) EBAC_RT;

  ScopeParams params_;
  std::shared_ptr<const Lumen> lumen_;
  Slave slave_;
  double base_;  // m, of the insertion motor at the start
  std::array<double, 4> gears_;
  double t_ = 0;                               // s
  std::array<std::atomic<double>, 4> x_{};     // m, of the cables
  std::array<std::atomic<double>, 4> load_{};  // N, at the cables
  std::array<std::atomic<double>, 6> report_{};
};

}  // namespace ebac::gastroscope
