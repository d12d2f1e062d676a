#include <sstream>
#include <tuple>

#include "bind.hpp"
#include "ebac/faults/campaign.hpp"
#include "fields.hpp"
#include "others_run.hpp"
#include "sweep.hpp"

namespace ebac::python {

namespace {

using faults::Result;

constexpr std::array kVerdicts{"passed",       "missed",   "false_alarm",  "wrong_name",
                               "not_zero",     "still_on", "beyond_limit", "restarted",
                               "not_recorded", "not_off",  "endless",      "late"};

/// The first rule of the referee that a case broke, with its numbers; empty where it broke none.
std::string text_of(const faults::Breach& breach) {
  const faults::RuleFacts& rule = faults::kRuleFacts[static_cast<std::size_t>(breach.rule)];
  if (breach.rule == faults::Rule::kNone) return {};
  const std::string unit = rule.unit == "1" ? "" : " " + std::string(rule.unit);
  std::ostringstream text;
  text << rule.name << ": " << breach.value << unit << " against " << breach.bound << unit
       << " on axis " << breach.axis << " in tick " << breach.tick;
  return text.str();
}

std::tuple<Values, std::vector<std::string>> run(std::size_t cases, std::uint64_t seed, int threads,
                                                 SweepProgress& progress) {
  faults::Campaign campaign;
  {
    const OthersRun release;
    campaign = faults::run_campaign(cases, seed, threads, progress);
  }
  const auto& rows = campaign.results;
  Values columns;
  columns["verdict"] =
      column<int>(rows, [](const Result& r) { return static_cast<int>(r.verdict); });
  columns["fault"] = column<int>(rows, [](const Result& r) { return static_cast<int>(r.fault); });
  columns["detected"] = column<std::int64_t>(rows, [](const Result& r) { return r.detected; });
  columns["to_zero"] = column<std::int64_t>(rows, [](const Result& r) { return r.to_zero; });
  columns["to_off"] = column<std::int64_t>(rows, [](const Result& r) { return r.to_off; });
  columns["done"] = column<bool>(campaign.done, [](char done) { return done != 0; });
  return {columns, std::vector<std::string>(kVerdicts.begin(), kVerdicts.end())};
}

}  // namespace

void bind_faults(py::module_& m) {
  m.def("_fault_campaign", &run, py::arg("cases"), py::arg("seed"), py::arg("threads"),
        py::arg("progress"),
        "Run a fault campaign; return a column per property of the cases, and the names of "
        "verdicts.");
  m.def(
      "_fault_case",
      [](std::uint64_t seed, std::uint64_t index) {
        const faults::InjectedFault injected = faults::injected_fault_of(seed, index);
        std::shared_ptr<Trace> trace;
        const Result result = faults::run_case(injected, &trace);
        return std::make_tuple(trace, injected.at, injected.ticks, injected.axis,
                               kVerdicts[static_cast<std::size_t>(result.verdict)],
                               text_of(result.breach));
      },
      py::arg("seed"), py::arg("index"),
      "Run one case; return its rows, first tick, ticks and axis of the fault, its verdict, and "
      "the "
      "rule that it broke.");
  m.def(
      "_fault_kinds",
      [] {
        std::vector<std::pair<std::string, std::string>> kinds;
        kinds.reserve(faults::kKindFacts.size());
        for (const auto& kind : faults::kKindFacts) kinds.emplace_back(kind.name, kind.what);
        return kinds;
      },
      "Name and meaning of every kind of fault; case i is of kind i modulo their number.");
}

}  // namespace ebac::python
