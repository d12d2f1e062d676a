/// The C interface that JavaScript calls. Text goes in and out through `text`, rows through
/// `columns`: both lie in the module's memory, where JavaScript reads them without a copy.
#include <algorithm>
#include <cstdint>
#include <memory>

#include "catalogue.hpp"
#include "ebac/model/device.hpp"
#include "ebac/sim/recorder.hpp"
#include "live_run.hpp"
#include "settings.hpp"

namespace ebac::wasm {

namespace {

constexpr int kRows = 4096;  // of a call of `step`
constexpr int kText = 256;   // bytes, of a name

std::array<char, kText> name_in{};
std::array<std::array<double, kRows>, Shown::fields().size()> columns{};
std::array<double, WallContact::fields().size() + 2> measured{};

Setup setup;
std::unique_ptr<LiveRun> run;
std::vector<Shown> record;
std::size_t keep = 0;  // rows, at least

std::string_view name(int length) {
  return {name_in.data(), static_cast<std::size_t>(std::clamp(length, 0, kText))};
}

LiveRun& running() {
  if (!run) throw std::invalid_argument("start a run before it is stepped");
  return *run;
}

void remember(const Shown& row) {
  if (keep > 0 && record.size() >= 2 * keep) {
    record.erase(record.begin(), record.end() - static_cast<std::ptrdiff_t>(keep));
  }
  record.push_back(row);
}

}  // namespace

extern "C" {

#define EBAC_EXPORT(name) [[gnu::used]] __attribute__((export_name(name)))

/// Where a name is written before a call that takes its length.
EBAC_EXPORT("name_at") char* name_at() { return name_in.data(); }

/// Laws, settings with unit and range, columns and measures: JSON, ended by a zero.
EBAC_EXPORT("catalogue") const char* catalogue_at() {
  static const std::string kText = catalogue();
  return kText.c_str();
}

/// All settings back to their defaults: those of `ebac.Scenario()`.
EBAC_EXPORT("reset") void reset() { setup = Setup{}; }

EBAC_EXPORT("set") void set_number(int length, double value) { set(setup, name(length), value); }

/// 0 without the observer, 1 with it, 2 for every law, 3 with the scale of the force learned.
EBAC_EXPORT("observe") void observe(int how) {
  setup.observer.reset();
  if (how == 0) return;
  setup.observer = ObserverParams::of(setup.device, setup.timing);
  setup.observer->every_law = how == 2;
  setup.observer->learn_scale = how == 3;
}

/// The seed of a scenario, and its jitter as a share of a tick.
EBAC_EXPORT("chance") void chance(double seed, double jitter) {
  setup.seed = static_cast<std::uint64_t>(seed);
  setup.jitter = jitter;
}

/// A new run under the law of that name, from rest at zero. Where it is refused the old one goes on.
EBAC_EXPORT("start") void start(int length) {
  check_device(setup.device);
  run = std::make_unique<LiveRun>(setup, law_named(name(length)));
  record.clear();
}

EBAC_EXPORT("aim") void aim(double target) { running().aim(target); }

EBAC_EXPORT("wall") void wall(double stiffness, double position) {
  Wall changed = running().wall();
  changed.stiffness = stiffness;
  changed.position = position;
  running().change(changed);
}

/// The columns of the last call of `step`, one behind the other, each `capacity` numbers long.
EBAC_EXPORT("columns") double* columns_at() { return columns[0].data(); }
EBAC_EXPORT("capacity") int capacity() { return kRows; }

/// Runs `ticks`, at most `capacity`, and returns the fault, 0 for none.
EBAC_EXPORT("step") int step(int ticks) {
  LiveRun& live = running();
  const auto fields = field_table<Shown>().rows;
  const int rows = std::clamp(ticks, 0, kRows);
  for (int i = 0; i < rows; ++i) {
    const Shown row = live.step();
    remember(row);
    for (std::size_t c = 0; c < fields.size(); ++c) {
      columns[c][static_cast<std::size_t>(i)] = fields[c].in<double>(&row);
    }
  }
  return static_cast<int>(live.fault());
}

/// From the next row on a contact is measured; of a long one the last `rows` at least, 0 for all.
EBAC_EXPORT("watch") void watch(int rows) {
  keep = static_cast<std::size_t>(std::max(0, rows));
  record.clear();
}

/// What `ebac.contact` measures, over the rows since `watch`: the numbers of the catalogue's
/// `measures`.
EBAC_EXPORT("measure") const double* measure() {
  static ContactRecorder recorder;
  recorder.start(record.size());
  for (const Shown& row : record) {
    recorder.add(row.t, row.energy, 0);
    recorder.add_axis(0, row.x, row.f_applied);
  }
  const WallContact contact = measure_contact(recorder.record());
  const auto fields = field_table<WallContact>().rows;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    measured[i] = fields[i].in<double>(&contact);
  }
  measured[fields.size()] = contact.still() ? 1 : 0;
  measured[fields.size() + 1] = contact.force_quiet() ? 1 : 0;
  return measured.data();
}

/// Runs `ticks` without a row: for a benchmark.
EBAC_EXPORT("spin") double spin(int ticks) {
  LiveRun& live = running();
  double last = 0;
  for (int i = 0; i < ticks; ++i) last = live.step().x;
  return last;
}

}  // extern "C"

}  // namespace ebac::wasm
