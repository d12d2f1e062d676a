// The referee of the fault campaign: silent where every rule is kept, and each broken rule named with its number.
#include "ebac/faults/referee.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>

#include "ebac/canopen/cob_id.hpp"

namespace ebac::faults::referee_test {
namespace {

constexpr double kDt = 1e-3;  // s

/// Two drives that are enabled from tick 5 on, with a soft start of 20 ms.
class Made {
 public:
  explicit Made(Kind kind = Kind::kStop, double angle = 0) : injected_{.kind = kind, .at = 1000} {
    made_.setup.environment = Wall{.angle = angle};
    made_.setup.device.kinematics = Linear{.axes = 2};
    made_.limits = Limits::of(made_.setup.device);
    made_.limits.peak_current = 2;
    made_.limits.slew = 500;
    made_.limits.thermal_time = 0.1;
    made_.plan = {.soft_start = 0.02, .ticks = 1000};
    made_.watching = kWatchings[1];
    referee_.emplace(made_, injected_);
  }

  /// The current of axis 1, and where its handle is, for some ticks.
  Made& ticks(int n, double current, double x = 0, double v = 0, double elapsed = kDt) {
    for (int i = 0; i < n; ++i) {
      ++injected_.tick;
      const bool on = injected_.tick >= 5 && injected_.tick < off_;
      if (beats_ && injected_.tick % 10 == 0) referee_->hear({.id = can::heartbeat(100)});
      const std::array<Seen, 2> seen{Seen{.enabled = on && other_},
                                     Seen{.current = current, .enabled = on, .x = x, .v = v}};
      referee_->watch(elapsed, seen);
    }
    return *this;
  }
  Made& law() {
    injected_.last_asked = injected_.tick;
    return *this;
  }
  Made& mute() {
    beats_ = false;
    return *this;
  }
  Made& lose_other() {
    other_ = false;
    return *this;
  }
  Made& finish() {
    referee_->finish();
    return *this;
  }
  const Breach& breach() const { return referee_->breach(); }
  Rule rule() const { return breach().rule; }
  double edge() const { return made_.limits.edge; }
  double continuous() const { return made_.limits.continuous_current; }

 private:
  CaseSetup made_{};
  InjectedFault injected_;
  std::optional<Referee> referee_;
  bool beats_ = true;
  bool other_ = true;
  std::int64_t off_ = 100000;  // tick
};

TEST(Referee, IsSilentWhereEveryRuleIsKept) {
  Made run;
  run.ticks(30, 0).law().ticks(20, 0.4).ticks(20, 0.8).ticks(20, 0).ticks(20, -0.5).ticks(20, 0);
  EXPECT_EQ(run.finish().rule(), Rule::kNone);
}

TEST(Referee, NamesPeakOfEitherSign) {
  EXPECT_EQ(Made()
                .ticks(40, 0)
                .ticks(5, 0.4)
                .ticks(1, 0.9)
                .ticks(1, 1.4)
                .ticks(1, 1.9)
                .ticks(1, 2.1)
                .rule(),
            Rule::kPeak);
  Made run;
  run.ticks(40, 0).ticks(1, -0.4).ticks(1, -0.9).ticks(1, -1.4).ticks(1, -1.9).ticks(1, -2.1);
  EXPECT_EQ(run.rule(), Rule::kPeak);
  EXPECT_DOUBLE_EQ(run.breach().value, 2.1);
  EXPECT_DOUBLE_EQ(run.breach().bound, 2);
  EXPECT_EQ(run.breach().axis, 1U);
  EXPECT_EQ(run.breach().tick, 44);
}

TEST(Referee, NamesSlewAwayFromZeroAlone) {
  Made run;
  run.ticks(40, 0).ticks(1, 0.6);
  EXPECT_EQ(run.rule(), Rule::kSlew);
  EXPECT_NEAR(run.breach().value, 600, 1e-9);
  EXPECT_EQ(Made().ticks(40, 0).ticks(1, 0.4).ticks(1, 0.8).ticks(1, 0).rule(), Rule::kNone);
  EXPECT_EQ(Made().ticks(40, 0).ticks(1, 0.4).ticks(1, -0.4).rule(), Rule::kSlew);
}

TEST(Referee, NamesHeatAfterItsOwnIntegral) {
  Made run;  // at 1.9 times the continuous current it is full after 0.1 s ln(3.6 / 2.6) = 32 ms
  run.ticks(40, 0).ticks(1, 0.5).ticks(1, 1).ticks(1, 1.5).ticks(25, 1.9 * run.continuous());
  EXPECT_EQ(run.rule(), Rule::kNone);
  run.ticks(15, 1.9 * run.continuous());
  EXPECT_EQ(run.rule(), Rule::kHeat);
}

TEST(Referee, NamesForceBeforeTheSoftStartAndAfterAPause) {
  EXPECT_EQ(Made().ticks(6, 0).ticks(1, 0.45).rule(), Rule::kSoftStart);
  EXPECT_EQ(Made().ticks(60, 0.0).ticks(1, 0.4, 0, 0, 0.02).ticks(1, 0.4).rule(), Rule::kSoftStart);
}

TEST(Referee, NamesCurrentAndLawBeforeEnablingAndCurrentBesideADriveThatIsOff) {
  EXPECT_EQ(Made().ticks(3, 0.1).rule(), Rule::kNotEnabled);
  EXPECT_EQ(Made().ticks(3, 0).law().ticks(1, 0).rule(), Rule::kEarlyLaw);
  EXPECT_EQ(Made().ticks(40, 0).ticks(5, 0.3).lose_other().ticks(3, 0.3).rule(), Rule::kNone);
  EXPECT_EQ(Made().ticks(40, 0).ticks(5, 0.3).lose_other().ticks(5, 0.3).rule(), Rule::kOthersOff);
}

TEST(Referee, NamesASoftWallThatIsNotThereOrPullsOutwards) {
  const double over = Made().edge() + 4e-3;
  EXPECT_EQ(Made().ticks(40, 0).ticks(5, 0.19, over).rule(), Rule::kNone);
  EXPECT_EQ(Made().ticks(40, 0).ticks(5, 0, over).rule(), Rule::kSoftWall);
  EXPECT_EQ(Made().ticks(40, 0).ticks(5, 0.19, -over).rule(), Rule::kSoftWall);
  EXPECT_EQ(Made().ticks(40, 0).ticks(5, 0, over, -0.1).rule(), Rule::kNone) << "on its way back";
}

TEST(Referee, NamesAWallThatPulls) {
  const double behind = 0.03;  // of a wall at 0
  EXPECT_EQ(Made().ticks(40, 0).ticks(20, 0.3, behind).rule(), Rule::kNone);
  EXPECT_EQ(Made().ticks(40, 0).ticks(20, -0.3, behind).rule(), Rule::kNone) << "it is beside it";
  EXPECT_EQ(Made(Kind::kStop, std::numbers::pi / 2).ticks(40, 0).ticks(20, -0.3, behind).rule(),
            Rule::kDirection);
}

TEST(Referee, NamesSpeedAndPlaceWithoutAStop) {
  EXPECT_EQ(Made().ticks(40, 0).ticks(5, 0, 0, 2).rule(), Rule::kNone);
  EXPECT_EQ(Made().ticks(40, 0).ticks(15, 0, 0, 2).rule(), Rule::kSpeed);
  EXPECT_EQ(Made().ticks(40, 0).ticks(15, 0, -0.07, 0).rule(), Rule::kWorkspace);
}

TEST(Referee, NamesALoopWithoutHeartbeatAndForceThatNeverCame) {
  EXPECT_EQ(Made().ticks(40, 0).mute().ticks(30, 0).rule(), Rule::kHeartbeat);
  EXPECT_EQ(Made(Kind::kForceHeld).ticks(40, 0).finish().rule(), Rule::kWithheld);
}

}  // namespace
}  // namespace ebac::faults::referee_test
