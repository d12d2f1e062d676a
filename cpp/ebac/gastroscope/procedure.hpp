#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ebac/control/any_law.hpp"
#include "ebac/gastroscope/lumen.hpp"
#include "ebac/gastroscope/task.hpp"

namespace ebac {
struct Setup;
struct SweepProgress;
}  // namespace ebac

namespace ebac::gastroscope {

/// Everything of a procedure but the joystick, the hand and the law.
struct Procedure {
  ScopeParams scope{};
  std::shared_ptr<const Lumen> lumen;
  MasterParams master{};
  PhysicianParams physician{};
  std::vector<Target> targets;
  double start = 0.09;  // m, of the camera behind the teeth
};

/// A procedure in numbers.
struct Findings {
  double seconds = 0;       // s
  double path = 0;          // m
  double touched = 0;       // targets
  double reached = 0;       // 0 or 1
  double most_tip = 0;      // N
  double most_section = 0;  // N
  double most_tube = 0;     // N
  double impulse = 0;       // N s
  double over_limit = 0;    // s
  double perforations = 0;  // 1
  double most_felt = 0;     // N
  double least_energy = 0;  // J
  double hand_work = 0;     // J
  double deepest = 0;       // m
  double fault = 0;         // 1

  static constexpr auto fields() {
    using F = Field<Findings>;
    using P = Findings;
    return std::array{
        F{"seconds", &P::seconds, "s", "until the pylorus was passed, or the end of the run"},
        F{"path", &P::path, "m", "way of the camera"},
        F{"touched", &P::touched, "1", "targets that were touched"},
        F{"reached", &P::reached, "1", "1 where the pylorus was passed"},
        F{"most_tip", &P::most_tip, "N", "largest force of the wall on the camera"},
        F{"most_section", &P::most_section, "N",
          "largest force of the wall on a point of the bending section or the camera"},
        F{"most_tube", &P::most_tube, "N", "largest force of the wall on a place of the tube"},
        F{"impulse", &P::impulse, "N s", "the force on the section, integrated"},
        F{"over_limit", &P::over_limit, "s", "time with that force above the limit"},
        F{"perforations", &P::perforations, "1",
          "times that force rose above that of a perforation"},
        F{"most_felt", &P::most_felt, "N", "largest force of the motors on the handle"},
        F{"least_energy", &P::least_energy, "J",
          "lowest physical port energy of all axes; negative: given out"},
        F{"hand_work", &P::hand_work, "J",
          "work of the hand on the handle, of either sign, summed"},
        F{"deepest", &P::deepest, "m", "farthest place of the camera along the lumen"},
        F{"fault", &P::fault, "1", "0, or why the loop stopped"},
    };
  }
};

/// One row of a procedure's record.
struct ProcedureRow {
  double t = 0, place = 0, inserted = 0;
  double x = 0, y = 0, z = 0, ahead_x = 0, ahead_y = 0, ahead_z = 0;
  double right_x = 0, right_y = 0, right_z = 0;
  double bend_x = 0, bend_y = 0, command_x = 0, command_y = 0, command_insertion = 0;
  double tip_force = 0, section_force = 0, tube_force = 0, push = 0;
  double handle_x = 0, handle_y = 0, handle_z = 0, felt_x = 0, felt_y = 0, felt_z = 0;
  double right = 0, down = 0, phase = 0, touched = 0;

  static constexpr auto fields() {
    using F = Field<ProcedureRow>;
    using P = ProcedureRow;
    return std::array{
        F{"t", &P::t, "s", "time"},
        F{"place", &P::place, "m", "of the camera along the lumen"},
        F{"inserted", &P::inserted, "m", "length of the scope behind the teeth"},
        F{"x", &P::x, "m", "camera, towards the patient's front"},
        F{"y", &P::y, "m", "camera, towards the patient's left"},
        F{"z", &P::z, "m", "camera, towards the head"},
        F{"ahead_x", &P::ahead_x, "1", "direction of view"},
        F{"ahead_y", &P::ahead_y, "1", "direction of view"},
        F{"ahead_z", &P::ahead_z, "1", "direction of view"},
        F{"right_x", &P::right_x, "1", "right-hand side of the picture"},
        F{"right_y", &P::right_y, "1", "right-hand side of the picture"},
        F{"right_z", &P::right_z, "1", "right-hand side of the picture"},
        F{"bend_x", &P::bend_x, "rad", "bend to the right"},
        F{"bend_y", &P::bend_y, "rad", "bend down"},
        F{"command_x", &P::command_x, "rad", "bend asked for"},
        F{"command_y", &P::command_y, "rad", "bend asked for"},
        F{"command_insertion", &P::command_insertion, "m",
          "insertion of the section's base asked for"},
        F{"tip_force", &P::tip_force, "N",
          "of the wall on the camera, largest since the row before"},
        F{"section_force", &P::section_force, "N",
          "of the wall on a point of the section, largest since the row before"},
        F{"tube_force", &P::tube_force, "N",
          "of the wall on a place of the tube, largest since the row before"},
        F{"push", &P::push, "N", "of the insertion motor"},
        F{"handle_x", &P::handle_x, "m", "handle"},
        F{"handle_y", &P::handle_y, "m", "handle"},
        F{"handle_z", &P::handle_z, "m", "handle, third axis"},
        F{"felt_x", &P::felt_x, "N", "motor force on the handle"},
        F{"felt_y", &P::felt_y, "N", "motor force on the handle"},
        F{"felt_z", &P::felt_z, "N", "motor force on the handle"},
        F{"right", &P::right, "rad", "bearing of the goal as it was seen"},
        F{"down", &P::down, "rad", "bearing of the goal as it was seen"},
        F{"phase", &P::phase, "1", "0 along the lumen, 1 at a target, 2 back, 3 done"},
        F{"touched", &P::touched, "1", "targets so far"},
    };
  }
};

class Slave;

/// A procedure tick by tick: the joystick's loop under the law, the line, slave and patient, the
/// physician.
class Navigation {
 public:
  Navigation(const Procedure& procedure, const Setup& setup, const AnyLaw& law);
  ~Navigation();
  Navigation(Navigation&&) noexcept;

  /// One tick; false where it had ended.
  bool step();
  /// Whether the pylorus was passed, the time is over or the loop stopped.
  bool ended() const;
  /// The newest row, with the largest forces since this was last asked.
  ProcedureRow row();
  const Findings& findings() const;
  const Slave& slave() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Runs a procedure: the joystick's loop under the law, the line, slave and patient, the physician.
/// A row is added to `rows`, where given, every `every` ticks and after the last one. Ends early where it is cancelled.
Findings run_procedure(const Procedure& procedure, const Setup& setup, const AnyLaw& law, int every,
                       SweepProgress& progress, std::vector<ProcedureRow>* rows);

/// Many of them, from `threads` threads, 0 for one per core.
std::vector<Findings> run_procedures(const std::vector<const Procedure*>& procedures,
                                     const std::vector<const Setup*>& setups,
                                     const std::vector<const AnyLaw*>& laws, int threads,
                                     SweepProgress& progress);

}  // namespace ebac::gastroscope
