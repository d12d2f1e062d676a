#pragma once

#include <array>

#include "ebac/gastroscope/bending.hpp"
#include "ebac/gastroscope/drive.hpp"
#include "ebac/gastroscope/lumen.hpp"
#include "ebac/gastroscope/messages.hpp"
#include "ebac/gastroscope/tube.hpp"

namespace ebac::gastroscope {

/// The gastroscope in the patient.
class Slave {
 public:
  /// Where the bending section meets the wall; the tip last.
  static constexpr std::size_t kPoints = 3;

  /// The camera `start` [m] behind the teeth. Keeps a pointer to the lumen.
  Slave(const ScopeParams& params, const Lumen& lumen, double start);

  /// One tick of `dt` [s] until time `t` [s].
  Answer step(const Command& command, double t, double dt) EBAC_RT;

  /// The same with motors that are elsewhere: `motors` is where they stand, not what they are asked.
  Answer carry(const Command& motors, double t, double dt) EBAC_RT;

  /// Where the insertion motor stands [m].
  double insertion() const EBAC_RT { return insert_.at; }
  /// Where the camera is, and its axes: right, down, ahead.
  const SectionPoint& camera() const EBAC_RT { return camera_; }
  /// The camera's place along the lumen [m].
  double place() const EBAC_RT { return place_; }
  /// Length of the scope behind the teeth, to the camera [m].
  double inserted() const EBAC_RT { return base_ + params_.section + params_.tip; }
  const Bend& bend() const EBAC_RT { return bend_; }
  /// Bend that the tendons ask for; with the section's stiffness, the torque at them.
  const Bend& pulled() const EBAC_RT { return pulled_; }
  const LumenMotion& motion() const EBAC_RT { return motion_; }
  const InsertionTube& tube() const EBAC_RT { return tube_; }

  /// Force of the wall on the camera, on any point of the section at most, on any place of the tube
  /// at most [N].
  double tip_force() const EBAC_RT { return tip_force_; }
  double section_force() const EBAC_RT { return section_force_; }
  double tube_force() const EBAC_RT { return tube_.most_force(); }
  /// Gap between the camera's edge and the wall [m]; negative in it.
  double gap() const EBAC_RT { return -touch_.back().depth; }
  /// Energy the patient's wall stores where the section presses it [J].
  double stored() const EBAC_RT;

 private:
  // What the wall moves: both bends, the base along the tube, the stomach as a bag.
  static constexpr std::size_t kMoved = 6;
  using Moved = std::array<double, kMoved>;

  /// A point of the section at the wall.
  struct Touch {
    double depth = 0;   // m; negative: free
    double before = 0;  // m, at the end of the last tick
    double force = 0;   // N per `way`
    double moves = 0;   // share of the bag's displacement
    Vec arm{}, way{};
    Moved per{};  // how the depth changes
  };
  /// What moves in a step: (damping/dt + stiffness) step = force - wall, the base with friction.
  struct Balance {
    Moved force{}, holds{}, wall{};
    double rub = 0;  // N

    double step(std::size_t i) const EBAC_RT;
  };

  void look() EBAC_RT;
  void press(Balance& balance, double dt) EBAC_RT;
  void advance(double dt) EBAC_RT;
  void lead(double dt) EBAC_RT;
  void settle(double base) EBAC_RT;
  void drive(const Command& command, double dt) EBAC_RT;
  void pull() EBAC_RT;
  Answer move(double t, double dt) EBAC_RT;

  static constexpr double kTubeEvery = 0.01;  // s, from one look at the tube to the next

  ScopeParams params_;
  const Lumen* lumen_;
  InsertionTube tube_;
  InsertionTube::Base at_{};
  MotorAxis insert_, rotate_, motor_x_, motor_y_;
  Tendon tendon_x_, tendon_y_;
  Bend pulled_{}, bend_{};
  double base_ = 0;  // m, of the section behind the teeth
  LumenMotion motion_{};
  SectionPoint camera_{};
  double place_ = 0;
  std::array<Along, kPoints> hint_{};
  std::array<Touch, kPoints> touch_{};
  std::array<double, 3> resists_{};  // of the wall against both bends [N m] and the base [N]
  double pressed_ = 0;               // N, of the section
  double tip_force_ = 0, section_force_ = 0;
  Vec tube_on_bag_{}, bag_then_{};  // N and m, when the tube was looked at
  double since_tube_ = 0;           // s
};

}  // namespace ebac::gastroscope
