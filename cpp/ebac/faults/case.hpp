#pragma once

#include <memory>

#include "ebac/faults/breach.hpp"
#include "ebac/faults/injected_fault.hpp"
#include "ebac/loop/trace.hpp"

namespace ebac::faults {

/// Why a case did not pass; kPassed when it did.
enum class Verdict : std::uint8_t {
  kPassed,
  kMissed,       // a fault that should have been found was not
  kFalseAlarm,   // one was found that was none
  kWrongName,    // it was found under another name
  kNotZero,      // the command was not zero within 2 ticks
  kStillOn,      // a drive was not disabled at the end of the loop
  kBeyondLimit,  // a rule of the referee was broken at some tick
  kRestarted,    // the loop or a drive started again without a reset
  kNotRecorded,  // a row or a change is missing
  kNotOff,       // a motor had current for too long
  kEndless,      // the loop did not end by itself
  kLate,         // the fault was found too late
};

struct Result {
  Verdict verdict = Verdict::kPassed;
  Fault fault = Fault::kNone;
  std::int64_t detected = 0;  // ticks from the beginning to the fault in the row
  std::int64_t to_zero = 0;   // ticks from that row to zero torque on the bus
  std::int64_t to_off = 0;    // ticks from that row to no current in any simulated motor
  Breach breach{};            // first rule of the referee that was broken, if any
};

/// The fault injected in case `index` of a campaign.
InjectedFault injected_fault_of(std::uint64_t seed, std::uint64_t index);

/// Runs one case and judges it. `trace` gets its rows when it is not null.
Result run_case(InjectedFault injected, std::shared_ptr<Trace>* trace = nullptr);

}  // namespace ebac::faults
