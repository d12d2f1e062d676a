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

/// All that moves.
struct Navigation::Parts {
  Parts(const Procedure& given, const Setup& setup, const AnyLaw& any)
      : procedure(given),
        slave(given.scope, *procedure.lumen, given.start),
        physician(given.physician, given.master, *procedure.lumen, given.targets, setup.seed,
                  setup.timing.dt),
        master(given.master, base()),
        there(late(setup), {.insertion = base()}),
        back(late(setup), {}),
        law(any),
        device(setup),
        clock(setup.timing.dt, setup.jitter, setup.seed),
        chain(setup.device, setup.environment, law.timing(), observing(setup.observer, law)),
        watch(procedure.lumen->params(), setup.timing.dt),
        dt(setup.timing.dt),
        count(row_count(setup)) {
    chain.change(External{felt});
    sample.axes = setup.device.axes();
  }

  double base() const { return slave.insertion(); }
  std::size_t late(const Setup& setup) const {
    return static_cast<std::size_t>(std::lround(procedure.master.delay / setup.timing.dt));
  }

  Procedure procedure;
  Slave slave;
  Physician physician;
  Master master;
  DelayLine<Command> there;
  DelayLine<Answer> back;
  PerAxis<AnyLaw> law;
  SimulatedDevice device;
  VirtualClock clock;
  SignalChain chain;
  std::shared_ptr<FromSlave> felt = std::make_shared<FromSlave>();
  Watch watch;
  Sample sample{};
  Command asked{};
  Answer answer{};
  double dt;
  std::size_t count, done = 0;
  bool clutched = true;
};

Navigation::Navigation(const Procedure& procedure, const Setup& setup, const AnyLaw& law)
    : parts_(std::make_unique<Parts>(procedure, setup, law)) {}
Navigation::~Navigation() = default;
Navigation::Navigation(Navigation&&) noexcept = default;

bool Navigation::ended() const {
  const Parts& p = *parts_;
  return p.done == p.count || p.sample.fault != Fault::kNone || p.watch.found.reached > 0;
}

bool Navigation::step() {
  Parts& p = *parts_;
  if (ended()) return false;
  tick(p.chain, p.law, p.device, p.clock.wait(), p.sample);
  const auto axes = static_cast<std::size_t>(p.sample.axes);
  Handle x{}, force{};
  for (std::size_t k = 0; k < axes; ++k) {
    x[k] = p.sample.axis[k].port.x;
    force[k] = p.device.state(k).f_motor;
  }
  const Wish wish = p.physician.step(p.slave, x, force, p.sample.t);
  for (std::size_t k = 0; k < axes; ++k) p.device.aim(k, wish.aim[k]);
  p.clutched = wish.clutched;
  p.asked = p.master.command(x, wish.pedal, p.clutched, p.dt);
  p.answer = p.slave.step(p.there.pass(p.asked), p.sample.t, p.dt);
  p.felt->force = p.master.felt(p.back.pass(p.answer), p.clutched);
  p.watch.tick(p.slave, p.sample, p.device);
  ++p.sample.tick;
  ++p.done;
  p.watch.found.touched = static_cast<double>(p.physician.touched());
  p.watch.found.fault = static_cast<double>(p.sample.fault);
  p.watch.found.reached = p.physician.phase() == Physician::Phase::kDone ? 1 : 0;
  return true;
}

ProcedureRow Navigation::row() {
  Parts& p = *parts_;
  const auto axes = static_cast<std::size_t>(p.sample.axes);
  return p.watch.with_forces(
      row_of(p.sample.t, p.slave, p.asked, p.answer, p.physician, p.device, axes));
}

const Findings& Navigation::findings() const { return parts_->watch.found; }
const Slave& Navigation::slave() const { return parts_->slave; }

Findings run_procedure(const Procedure& procedure, const Setup& setup, const AnyLaw& law, int every,
                       SweepProgress& progress, std::vector<ProcedureRow>* rows) {
  Navigation run(procedure, setup, law);
  for (std::size_t i = 0; !progress.cancelled.load(std::memory_order_relaxed) && run.step(); ++i) {
    if (rows != nullptr && (run.ended() || i % static_cast<std::size_t>(every) == 0)) {
      rows->push_back(run.row());
    }
  }
  return run.findings();
}

std::vector<Findings> run_procedures(const std::vector<const Procedure*>& procedures,
                                     const std::vector<const Setup*>& setups,
                                     const std::vector<const AnyLaw*>& laws, int threads,
                                     SweepProgress& progress) {
  std::vector<Findings> found(procedures.size());
  for_each_run(procedures.size(), threads, progress, [&](std::size_t i, ContactRecorder&) {
    found[i] = run_procedure(*procedures[i], *setups[i], *laws[i], 1, progress, nullptr);
  });
  return found;
}

}  // namespace ebac::gastroscope
