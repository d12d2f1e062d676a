#include "ebac/gastroscope/procedure.hpp"

#include <algorithm>
#include <cmath>

#include "ebac/gastroscope/physician.hpp"
#include "ebac/sim/sweep.hpp"

namespace ebac::gastroscope {

namespace {

/// The world of the joystick: the force that has come from the slave.
class FromSlave final : public World {
 public:
  ContactForce contact(const Axes&, const Axes&, double) EBAC_RT override {
    return ContactForce::straight({force[0], force[1], force[2]});
  }
  std::unique_ptr<World> fresh() const override { return std::make_unique<FromSlave>(); }

  Handle force{};  // N
};

/// What a procedure adds up to.
class Watch {
 public:
  Watch(const PatientParams& patient, double dt) : patient_(patient), dt_(dt) {}

  void tick(const Slave& slave, const Sample& s, const SimulatedDevice& device) EBAC_RT {
    Findings& f = found;
    f.seconds = s.t;
    f.path += s.tick > 0 ? norm(slave.camera().at - before_) : 0.0;
    before_ = slave.camera().at;
    const double force = slave.section_force();
    since_row_.tip_force = std::max(since_row_.tip_force, slave.tip_force());
    since_row_.section_force = std::max(since_row_.section_force, force);
    since_row_.tube_force = std::max(since_row_.tube_force, slave.tube_force());
    f.most_tip = std::max(f.most_tip, since_row_.tip_force);
    f.most_section = std::max(f.most_section, since_row_.section_force);
    f.most_tube = std::max(f.most_tube, since_row_.tube_force);
    f.deepest = std::max(f.deepest, slave.place());
    f.impulse += dt_ * force;
    f.over_limit += force > patient_.force_limit ? dt_ : 0.0;
    const bool through = force > patient_.perforation;
    f.perforations += through && !through_ ? 1 : 0;
    through_ = through;
    double energy = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.axes); ++i) {
      const AxisTruth& truth = device.state(i);
      energy += truth.energy;
      f.hand_work += dt_ * std::abs(truth.f_hand * truth.v);
      f.most_felt = std::max(f.most_felt, std::abs(truth.f_motor));
    }
    f.least_energy = std::min(f.least_energy, energy);
  }

  /// The wall's forces of a row: the largest since the row before, so that no spike lies between two.
  ProcedureRow with_forces(ProcedureRow row) EBAC_RT {
    row.tip_force = since_row_.tip_force;
    row.section_force = since_row_.section_force;
    row.tube_force = since_row_.tube_force;
    since_row_ = {};
    return row;
  }

  Findings found;

 private:
  struct Forces {
    double tip_force = 0, section_force = 0, tube_force = 0;  // N
  };
  PatientParams patient_;
  double dt_;
  Forces since_row_;
  Vec before_{};
  bool through_ = false;
};

ProcedureRow row_of(double t, const Slave& slave, const Command& command, const Answer& answer,
                    const Physician& physician, const SimulatedDevice& device, std::size_t axes) {
  const Vec& at = slave.camera().at;
  const Frame& camera = slave.camera().camera;
  const View& seen = physician.seen();
  Handle x{}, force{};
  for (std::size_t i = 0; i < axes; ++i) {
    x[i] = device.state(i).x;
    force[i] = device.state(i).f_motor;
  }
  return {.t = t,
          .place = slave.place(),
          .inserted = slave.inserted(),
          .x = at.x,
          .y = at.y,
          .z = at.z,
          .ahead_x = camera.z.x,
          .ahead_y = camera.z.y,
          .ahead_z = camera.z.z,
          .right_x = camera.x.x,
          .right_y = camera.x.y,
          .right_z = camera.x.z,
          .bend_x = slave.bend().x,
          .bend_y = slave.bend().y,
          .command_x = command.bend_x,
          .command_y = command.bend_y,
          .command_insertion = command.insertion,
          .push = answer.push,
          .handle_x = x[0],
          .handle_y = x[1],
          .handle_z = x[2],
          .felt_x = force[0],
          .felt_y = force[1],
          .felt_z = force[2],
          .right = seen.right,
          .down = seen.down,
          .phase = static_cast<double>(physician.phase()),
          .touched = static_cast<double>(physician.touched())};
}

}  // namespace

Findings run_procedure(const Procedure& procedure, const Setup& setup, const AnyLaw& any, int every,
                       std::vector<ProcedureRow>* rows) {
  const double dt = setup.timing.dt;
  const auto late = static_cast<std::size_t>(std::lround(procedure.master.delay / dt));
  const Lumen& lumen = *procedure.lumen;
  Slave slave(procedure.scope, lumen, procedure.start);
  Physician physician(procedure.physician, procedure.master, lumen, procedure.targets, setup.seed,
                      dt);
  const double base = slave.inserted() - procedure.scope.section - procedure.scope.tip;
  Master master(procedure.master, base);
  DelayLine<Command> there(late, {.insertion = base});
  DelayLine<Answer> back(late, {});

  PerAxis<AnyLaw> law(any);
  SimulatedDevice device(setup);
  VirtualClock clock(dt, setup.jitter, setup.seed);
  SignalChain chain(setup.device, setup.environment, observing(setup.observer, law));
  const auto felt = std::make_shared<FromSlave>();
  chain.change(External{felt});
  Sample sample{};
  sample.axes = setup.device.axes();
  const auto axes = static_cast<std::size_t>(sample.axes);

  Watch watch(lumen.params(), dt);
  const std::size_t count = row_count(setup);
  bool clutched = true;
  for (std::size_t i = 0; i < count && sample.fault == Fault::kNone; ++i) {
    tick(chain, law, device, clock.wait(), sample);
    Handle x{}, force{};
    for (std::size_t k = 0; k < axes; ++k) {
      x[k] = sample.axis[k].port.x;
      force[k] = device.state(k).f_motor;
    }
    const Wish wish = physician.step(slave, x, force, sample.t);
    for (std::size_t k = 0; k < axes; ++k) device.aim(k, wish.aim[k]);
    clutched = wish.clutched;
    const Command& asked = master.command(x, wish.pedal, clutched, dt);
    const Answer answer = slave.step(there.pass(asked), sample.t, dt);
    felt->force = master.felt(back.pass(answer), clutched);
    watch.tick(slave, sample, device);
    const bool done = physician.phase() == Physician::Phase::kDone;
    const bool last = done || i + 1 == count || sample.fault != Fault::kNone;
    if (rows != nullptr && (last || i % static_cast<std::size_t>(every) == 0)) {
      rows->push_back(
          watch.with_forces(row_of(sample.t, slave, asked, answer, physician, device, axes)));
    }
    ++sample.tick;
    if (done) {
      watch.found.reached = 1;
      break;
    }
  }
  watch.found.touched = static_cast<double>(physician.touched());
  watch.found.fault = static_cast<double>(sample.fault);
  return watch.found;
}

std::vector<Findings> run_procedures(const std::vector<const Procedure*>& procedures,
                                     const std::vector<const Setup*>& setups,
                                     const std::vector<const AnyLaw*>& laws, int threads,
                                     SweepProgress& progress) {
  std::vector<Findings> found(procedures.size());
  for_each_run(procedures.size(), threads, progress, [&](std::size_t i, ContactRecorder&) {
    found[i] = run_procedure(*procedures[i], *setups[i], *laws[i], 1, nullptr);
  });
  return found;
}

}  // namespace ebac::gastroscope
