#pragma once

#include <ebac/loop/clock.hpp>
#include <ebac/loop/signal_chain.hpp>
#include <ebac/rt/loop_thread.hpp>
#include <ebac/rt/monotonic_clock.hpp>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "exchange.hpp"
#include "posted_force.hpp"

namespace chai {

/// A loop of ebac in a thread of its own, whatever device, clock and law it has.
class Runner {
 public:
  virtual ~Runner() = default;
  /// Starts, with the forces that come through `exchange`.
  virtual void start(const std::shared_ptr<Exchange>& exchange) = 0;
  /// Stops, and waits for the end.
  virtual void stop() = 0;
  virtual bool running() const = 0;
  /// The rows of the run; readable while it goes on.
  virtual const ebac::Trace& trace() const = 0;
  virtual const ebac::DeviceModel& model() const = 0;

 protected:
  Runner() = default;
  Runner(const Runner&) = default;
  Runner& operator=(const Runner&) = default;
};

/// Virtual time that goes on when the haptic thread has answered: the same rows in every run.
class SteppedClock {
 public:
  SteppedClock(double dt, std::shared_ptr<Exchange> exchange)
      : clock_(dt, 0, 1), exchange_(std::move(exchange)) {}
  ebac::Instant wait() EBAC_RT {
    exchange_->wait_for_force();
    return clock_.wait();
  }

 private:
  ebac::VirtualClock clock_;
  std::shared_ptr<Exchange> exchange_;
};

struct RunOptions {
  ebac::DeviceModel device;
  ebac::Timing timing;
  ebac::LoopOptions loop;
  double stiffness = 0;      // N/m, of the plane that stands for a late force; 0: the force is held
  std::size_t rows = 10000;  // of the recording
  bool ring = false;         // whether these are the last ones, of a run without end
};

/// The clock that a loop gets when it starts.
template <class C>
C clock_for(const RunOptions& options, const std::shared_ptr<Exchange>& exchange) {
  if constexpr (std::is_same_v<C, SteppedClock>) {
    return SteppedClock(options.timing.dt, exchange);
  } else {
    return C(options.timing.dt);
  }
}

template <ebac::Device D, ebac::Clock C>
class LoopRunner final : public Runner {
 public:
  LoopRunner(D device, const RunOptions& options, ebac::AnyLaw law)
      : device_(std::move(device)), options_(options), law_(std::move(law)) {}
  ~LoopRunner() override { stop(); }
  LoopRunner(const LoopRunner&) = delete;
  LoopRunner& operator=(const LoopRunner&) = delete;
  LoopRunner(LoopRunner&&) = delete;
  LoopRunner& operator=(LoopRunner&&) = delete;

  void start(const std::shared_ptr<Exchange>& exchange) override {
    if (thread_ || !device_) return;
    exchange_ = exchange;
    const ebac::External world{std::make_shared<PostedForce>(exchange, options_.stiffness)};
    auto loop = std::make_unique<Loop>(std::move(*device_), clock_for<C>(options_, exchange),
                                       Law(law_), ebac::SignalChain(options_.device, world),
                                       options_.device.axes(), options_.loop);
    device_.reset();
    trace_ = loop->make_trace(options_.rows, options_.ring);
    const auto mode =
        std::is_same_v<C, SteppedClock> ? ebac::rt::Mode::kOff : ebac::rt::Mode::kAuto;
    thread_.emplace(std::move(loop), trace_, std::make_shared<ebac::ParameterUpdates<Law>>(law_),
                    mode, ebac::rt::Options{});
  }
  void stop() override {
    if (!thread_) return;
    thread_->stop();
    exchange_->part();
    thread_->join();
  }
  bool running() const override { return thread_ && !thread_->done(); }
  const ebac::Trace& trace() const override { return *trace_; }
  const ebac::DeviceModel& model() const override { return options_.device; }

 private:
  using Law = ebac::PerAxis<ebac::AnyLaw>;
  using Loop = ebac::Loop<D, C, Law>;

  std::optional<D> device_;  // until it starts
  RunOptions options_;
  ebac::AnyLaw law_;
  std::shared_ptr<Exchange> exchange_;
  std::shared_ptr<ebac::Trace> trace_;
  std::optional<ebac::rt::LoopThread<D, C, Law>> thread_;
};

}  // namespace chai
