#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <memory>

#include "ebac/gastroscope/driven_scope.hpp"
#include "ebac/model/world.hpp"
#include "ebac/remote/link_end.hpp"

namespace ebac::remote {

/// How the slave's drives follow what comes from the master.
struct FollowParams {
  double stiffness = 4000;        // N/m
  double damping = 30;            // N s/m
  double most_force = 25;         // N
  double insertion_speed = 0.08;  // m/s
  double turn_speed = 2;          // rad/s
  double realign = 0.5;           // rad/s
  double deepest = 0.8;           // m
  double most_bend = 2.6;         // rad

  static constexpr auto fields() {
    using F = Field<FollowParams>;
    using P = FollowParams;
    return std::array{
        F{"stiffness", &P::stiffness, "N/m", "of every position controller, at its cable", 1, 1e6},
        F{"damping", &P::damping, "N s/m", "of the same", 0, 1e4},
        F{"most_force", &P::most_force, "N", "largest force asked of a drive", 0.1, 1e3},
        F{"insertion_speed", &P::insertion_speed, "m/s", "fastest insertion", 1e-3, 1},
        F{"turn_speed", &P::turn_speed, "rad/s", "fastest rotation and bend", 0.01, 50},
        F{"realign", &P::realign, "rad/s",
          "fastest rotation and bend back to the stick at the beginning and after consent", 0.01,
          50},
        F{"deepest", &P::deepest, "m", "insertion from where the drives began, at most", 0.01, 2},
        F{"most_bend", &P::most_bend, "rad", "largest bend asked of the drives", 0.1, 4},
    };
  }
};

/// Where the slave's four axes shall be, from what the master asks.
class Targets {
 public:
  explicit Targets(const FollowParams& params) : params_(checked(params, "Follow")) {}

  /// The axes stand here: nothing moves by itself.
  void start(const Four& at) EBAC_RT { at_ = at; }
  /// A session begins: insertion goes on from here, and the bends go back to the stick slowly.
  void begin() EBAC_RT {
    zero_ = at_[0];
    aligned_ = false;
  }
  /// One step of `dt` [s] towards what the master asks. Bounded in place and speed.
  void follow(const Four& asked, double dt) EBAC_RT;
  /// They stand still.
  void hold() EBAC_RT { rate_ = {}; }

  const Four& at() const EBAC_RT { return at_; }
  const Four& rate() const EBAC_RT { return rate_; }
  /// Insertion at which the session began [m].
  double zero() const EBAC_RT { return zero_; }

 private:
  static constexpr double kSmooth = 5e-3;   // s: packets would be steps otherwise
  static constexpr double kAligned = 0.02;  // rad

  FollowParams params_;
  Four at_{};    // m, rad
  Four rate_{};  // m/s, rad/s
  double zero_ = 0;
  bool aligned_ = false;
};

/// What the two loops of the slave share. The first, of insertion and rotation, has the link.
class SlaveLink {
 public:
  SlaveLink(std::shared_ptr<LinkEnd> link, const FollowParams& params,
            const gastroscope::Gears& gears);

  /// The world of the drives of group 0 or 1.
  static std::shared_ptr<World> world(std::shared_ptr<SlaveLink> slave, std::size_t group);

  ContactForce contact(std::size_t group, const Axes& x, const Axes& v, double t) EBAC_RT;
  LinkEnd& link() EBAC_RT { return *link_; }

 private:
  static constexpr double kSilent = 0.1;  // s, of either group

  void lead(double t) EBAC_RT;
  void start() EBAC_RT;
  void watch_group(double dt) EBAC_RT;
  bool is_led(double t) EBAC_RT;
  void describe(double dt) EBAC_RT;

  std::shared_ptr<LinkEnd> link_;
  FollowParams params_;
  Targets targets_;
  Four gears_;
  std::uint32_t session_ = 0;
  double t_ = 0;       // s
  double silent_ = 0;  // s, of the second group
  Four held_at_{};
  bool begun_ = false;
  bool holding_ = false;
  bool alone_ = false;
  std::int64_t beats_ = 0;                       // of the second group, seen
  std::atomic<std::int64_t> beat_{0};            // of the second group
  std::atomic<std::int64_t> led_{0};             // ticks of the first group
  std::int64_t seen_{0};                         // of them, by the second group
  double led_at_ = 0;                            // s, by the second group's clock
  std::atomic<bool> started_{false};             // both know where they stand
  std::array<std::atomic<double>, 4> wanted_{};  // m, at the cables
  std::array<std::atomic<double>, 4> rate_{};    // m/s
  std::array<std::atomic<double>, 4> at_{};      // m
  std::array<std::atomic<double>, 4> force_{};   // N, of the controllers
};

}  // namespace ebac::remote
