// Hands beyond eq. (4) in the plant: a hand of one's own, and that a model is integrated as exactly as the device.
#include "ebac/model/hand_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "ebac/model/exact_plant.hpp"
#include "ebac/model/stepped_plant.hpp"

namespace ebac::hand_model_test {
namespace {

constexpr double kTick = 1e-3;
constexpr double kTarget = 0.03;

/// Eq. (4), as a user would write it.
class Spring final : public HandForce {
 public:
  double force(const HandMotion& at, const HandState&) const EBAC_RT override {
    return 300 * (kTarget - at.x) - 6 * at.v;
  }
  std::unique_ptr<HandForce> clone() const override { return std::make_unique<Spring>(*this); }
};

/// The same with the spring's force as a state of its own: F' = -K v.
class SpringState final : public HandForce {
 public:
  double force(const HandMotion& at, const HandState& z) const EBAC_RT override {
    return 300 * kTarget + z[0] - 6 * at.v;
  }
  HandState rate(const HandMotion& at, const HandState&) const EBAC_RT override {
    HandState change = HandState::Zero();
    change[0] = -300 * at.v;
    return change;
  }
  std::unique_ptr<HandForce> clone() const override { return std::make_unique<SpringState>(*this); }
};

Hand own(std::shared_ptr<const HandForce> force) {
  Hand hand;
  hand.model = OwnHand{std::move(force)};
  return hand;
}

double place_after(const Hand& hand, double tick, double seconds, double friction = 0) {
  DeviceModel device;
  device.mechanics.coulomb = friction;
  SteppedPlant plant(device, hand, tick);
  const auto ticks = std::lround(seconds / tick);
  for (long k = 0; k < ticks; ++k)
    plant.advance({0.3, 0, 0}, static_cast<double>(k) * tick, kQuanta);
  return plant.truth(0).x;
}

Hand with(const HandModel& model) {
  Hand hand;
  hand.path[0] = Step{.target = kTarget};
  hand.model = model;
  return hand;
}

TEST(HandModel, AHandOfOnesOwnMovesAsEq4) {
  const Hand eq4 = with({});
  for (const Hand& hand : {own(std::make_shared<Spring>()), own(std::make_shared<SpringState>())}) {
    DeviceModel device;
    ExactPlant exact(device, eq4, kTick);
    SteppedPlant stepped(device, hand, kTick);
    for (int k = 0; k < 300; ++k) {
      const Axes current{0.4 * std::sin(0.1 * k), 0, 0};
      exact.advance(current, k * kTick, kQuanta);
      stepped.advance(current, k * kTick, kQuanta);
      ASSERT_NEAR(exact.truth(0).x, stepped.truth(0).x, 1e-9);
      ASSERT_NEAR(exact.truth(0).f_hand, stepped.truth(0).f_hand, 1e-5);
      ASSERT_NEAR(exact.truth(0).f_sensor, stepped.truth(0).f_sensor, 1e-4);
      ASSERT_NEAR(exact.truth(0).energy, stepped.truth(0).energy, 1e-8);
    }
  }
}

/// What the steps leave is far below an encoder count of 31 um; friction brings events.
TEST(HandModel, FinerTicksMoveNoPresetByMuch) {
  const HandModel models[] = {Reflex{}, FingerPad{}, NonlinearGrip{},
                              LetGo{.open_at = 0.2, .closed_at = 0.3}};
  for (const HandModel& model : models) {
    for (const double friction : {0.0, 0.5}) {
      const double coarse = place_after(with(model), kTick, 0.5, friction);
      const double fine = place_after(with(model), kTick / 4, 0.5, friction);
      EXPECT_NEAR(coarse, fine, 1e-7) << "model " << model.index() << ", friction " << friction;
    }
  }
}

TEST(HandModel, ACopiedPlantGoesOnAlike) {
  const DeviceModel device;
  SteppedPlant plant(device, with(Reflex{}), kTick);
  for (int k = 0; k < 100; ++k) plant.advance(Axes::Zero(), k * kTick, kQuanta);
  SteppedPlant copy = plant;
  for (int k = 100; k < 200; ++k) {
    plant.advance(Axes::Zero(), k * kTick, kQuanta);
    copy.advance(Axes::Zero(), k * kTick, kQuanta);
  }
  EXPECT_EQ(plant.truth(0).x, copy.truth(0).x);
}

TEST(HandModel, ReleasedForGoodGivesNoForce) {
  Hand hand = with(FingerPad{});
  hand.release_at = 0.1;
  SteppedPlant plant(DeviceModel{}, hand, kTick);
  for (int k = 0; k < 150; ++k) plant.advance(Axes::Zero(), k * kTick, kQuanta);
  EXPECT_EQ(plant.truth(0).f_hand, 0);
  EXPECT_GT(plant.truth(0).x, 0);
}

TEST(HandModel, TheExactPlantRefusesIt) {
  EXPECT_THROW(ExactPlant(DeviceModel{}, with(Reflex{}), kTick), std::invalid_argument);
  EXPECT_FALSE(ExactPlant::covers(DeviceModel{}, with(Reflex{})));
}

static_assert(std::is_nothrow_move_constructible_v<HandForces>);

}  // namespace
}  // namespace ebac::hand_model_test
