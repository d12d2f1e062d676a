#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ebac/control/law_types.hpp>
#include <ebac/control/per_axis.hpp>
#include <ebac/loop/trace.hpp>
#include <ebac/sim/contact.hpp>
#include <ebac/sim/setup.hpp>
#include <string_view>

namespace chai {

/// What came of a run.
struct Result {
  std::string_view scene;
  std::string_view law;
  double stiffness = 0;  // N/m
  double swing = 0;  // m, peak to peak over the last 30 % of the run, of the axis that swings most
  double rest = 0;   // m, mean of the first axis over the same time
  double least_energy = 0;  // J, lowest energy of all ports: below zero the device gave it out
  double tick = 0;          // s, mean time of a tick
  ebac::Fault fault = ebac::Fault::kNone;
  std::size_t ticks = 0;
};

/// The simulated device of three straight axes, and a hand that goes 30 mm deeper than the surface, a little aslant.
inline ebac::Setup setup_of(double seconds) {
  ebac::Setup setup;
  setup.device.kinematics = ebac::Linear{.axes = 3};
  setup.seconds = seconds;
  const std::array target{0.04, 0.006, 0.004};  // m
  for (std::size_t i = 0; i < target.size(); ++i)
    setup.hand.path[i] = ebac::Step{.target = target[i]};
  return setup;
}

/// A law by its name, as designed for the device.
inline ebac::AnyLaw law_of(std::string_view name, const ebac::Setup& setup) {
  const ebac::LawType& type = ebac::law_named(name);
  std::vector<double> params(type.params.size / sizeof(double) + 1);
  type.design(params.data(), setup.device.facts(), setup.timing);
  return type.make(params.data(), setup.timing);
}

inline void measure(const ebac::Trace& trace, Result& result) {
  result.ticks = trace.size();
  const std::size_t first = trace.first();
  const auto tail = first + static_cast<std::size_t>((1 - ebac::kTailShare) *
                                                     static_cast<double>(trace.size() - first));
  ebac::Axes low = ebac::Axes::Constant(1e9);
  ebac::Axes high = -low;
  double sum = 0;
  for (std::size_t row = first; row < trace.size(); ++row) {
    const ebac::Sample sample = trace.sample(row);
    double energy = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(trace.axes()); ++i) {
      const ebac::Port& port = sample.axis[i].port;
      energy += port.work + port.damped;
      if (row < tail) continue;
      const auto e = static_cast<Eigen::Index>(i);
      low[e] = std::min(low[e], port.x);
      high[e] = std::max(high[e], port.x);
    }
    if (row >= tail) sum += sample.axis[0].port.x;
    result.least_energy = std::min(result.least_energy, energy);
    result.fault = sample.fault;
  }
  result.swing = (high - low).head(trace.axes()).maxCoeff();
  result.rest = sum / static_cast<double>(trace.size() - tail);
}

/// Swings and energy that a user would call quiet.
inline bool quiet(const Result& result) {
  return result.fault == ebac::Fault::kNone && result.swing < ebac::kStillSwing &&
         result.least_energy > -1e-3;
}

inline void print_head() {
  std::printf("%-14s %-18s %7s %10s %10s %12s %10s\n", "scene", "law", "N/m", "swing", "rest",
              "energy out", "a tick");
}

inline void print_row(const Result& r) {
  std::printf("%-14.*s %-18.*s %7.0f %7.3f mm %7.3f mm %9.3f mJ %7.2f us%s\n",
              static_cast<int>(r.scene.size()), r.scene.data(), static_cast<int>(r.law.size()),
              r.law.data(), r.stiffness, 1e3 * r.swing, 1e3 * r.rest, -1e3 * r.least_energy,
              1e6 * r.tick, r.fault == ebac::Fault::kNone ? "" : "  FAULT");
}

inline void print_json(std::string_view program, const std::vector<Result>& results) {
  std::printf("{\"program\": \"%.*s\", \"rows\": [", static_cast<int>(program.size()),
              program.data());
  const char* before = "\n";
  for (const Result& r : results) {
    std::printf(
        "%s  {\"scene\": \"%.*s\", \"law\": \"%.*s\", \"stiffness_N_per_m\": %g, \"swing_m\": "
        "%.9g, \"rest_m\": %.9g, "
        "\"least_energy_J\": %.9g, \"tick_s\": %.4g, \"ticks\": %zu, \"fault\": %d}",
        before, static_cast<int>(r.scene.size()), r.scene.data(), static_cast<int>(r.law.size()),
        r.law.data(), r.stiffness, r.swing, r.rest, r.least_energy, r.tick, r.ticks,
        static_cast<int>(r.fault));
    before = ",\n";
  }
  std::printf("\n]}\n");
}

}  // namespace chai
