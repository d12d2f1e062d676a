// Master and slave over UDP, each in a thread of its own; consent comes from a third.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include "ebac/control/law_types.hpp"
#include "ebac/teleop/udp_sides.hpp"

namespace ebac::teleop_udp_test {
namespace {

using namespace teleop;

constexpr sensor::Endpoint kHere{.address = sensor::kLoopbackAddress, .port = 0};

/// A side that runs until it is told to stop.
template <class Side>
class Running {
 public:
  explicit Running(Side& side)
      : thread_([this, &side] {
          while (!over_) side.run(0.05);
        }) {}
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

TEST(TeleopUdp, AHandConsentsWhileTheMasterRuns) {
  const Coupling coupling{.timeout = 0.2};
  UdpSlave slave(SlaveModel{}, coupling, kHere);
  const sensor::Endpoint place = slave.local();
  const LawType& direct = law_named("direct");
  UdpMaster master(ebac::Setup{}, direct.make(direct.params.initial, Timing{}), coupling, kHere,
                   place, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(master.consent()) << "before it runs there is nothing to consent to";
  {
    const Running serves(slave);
    master.run(0.2);
  }
  master.run(0.4);  // the slave is silent
  const Running serves(slave);
  bool consented = false;
  {
    const Running works(master);
    for (int i = 0; i < 500 && !consented; ++i) {
      consented = master.consent();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_TRUE(consented);
  EXPECT_EQ(master.run(0.01).session, 2);
}

}  // namespace
}  // namespace ebac::teleop_udp_test
