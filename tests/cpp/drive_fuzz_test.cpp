// A million frames, random and half right: the drive answers as the protocols allow, and its state
// machine makes no step that is not in the table. Seeded; the sanitizers watch.
#include <random>

#include "transcript.hpp"

namespace ebac::can::drive_fuzz_test {
namespace {

constexpr int kFrames = 1'000'000;

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}

  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  template <class T, std::size_t N>
  T of(const std::array<T, N>& all) {
    return all[below(N)];
  }

 private:
  std::mt19937_64 random_;
};

/// Anything.
Frame noise(Chance& chance) {
  Frame frame{.id = static_cast<std::uint32_t>(chance.below(0x800)),
              .size = static_cast<std::uint8_t>(chance.below(9))};
  for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(chance.below(256));
  if (chance.one_in(50)) frame.remote = true;
  if (chance.one_in(50)) frame.extended = true;
  return frame;
}

/// An SDO request to an object there is, with values that mean something now and then.
Frame request(Chance& chance) {
  const Entry& entry = kDriveTable.entry[chance.below(kDriveTable.entries)];
  Frame frame{.id = sdo_request(1), .size = 8};
  constexpr std::array<std::uint8_t, 12> kCommands{0x40, 0x2F, 0x2B, 0x23, 0x22, 0x21,
                                                   0x20, 0x60, 0x70, 0x00, 0x11, 0x80};
  frame.data[0] = chance.of(kCommands);
  put<std::uint16_t>(frame.data, 1, entry.index);
  frame.data[3] = entry.sub;
  constexpr std::array<std::uint32_t, 18> kValues{
      0,          1,          2,          30,         100,        0xFFFFFFFF,
      0x80000201, 0x201,      0xC0000181, 0x40000181, 0x60400010, 0x60710010,
      0x60410010, 0x60640020, 0x65766173, 0x64616F6C, 0x00050064, 0x0000000A};
  put<std::uint32_t>(frame.data, 4, chance.of(kValues));
  return frame;
}

/// What a master says all day.
Frame sensible(Chance& chance) {
  constexpr std::array<std::uint8_t, 9> kWords{0, 2, 6, 7, 15, 15, 0x80, 0x0F, 0x8F};
  constexpr std::array<std::uint8_t, 6> kNmtCommands{1, 1, 1, 2, 0x80, 0x82};
  switch (chance.below(5)) {
    case 0:
      return frame(kSync, {});
    case 1:
      return frame(kNmt, {chance.one_in(20) ? std::uint8_t{0x81} : chance.of(kNmtCommands), 0});
    case 2:
      return frame(heartbeat(5), {5});
    case 3:
      return frame(rpdo(1, 1), {chance.of(kWords), 0, static_cast<std::uint8_t>(chance.below(256)),
                                static_cast<std::uint8_t>(chance.below(8))});
    default:
      return frame(sdo_request(1), {0x2B, 0x40, 0x60, 0, chance.of(kWords), 0, 0, 0});
  }
}

Frame mutated(Chance& chance, Frame frame) {
  if (chance.one_in(4)) {
    frame.data[chance.below(8)] ^= static_cast<std::uint8_t>(1U << chance.below(8));
  }
  if (chance.one_in(16)) frame.size = static_cast<std::uint8_t>(chance.below(9));
  return frame;
}

/// Reachable by one frame: a command, a fault, a loss of connection, or a restart.
bool may_follow(DriveState before, DriveState now) {
  if (now == before || now == DriveState::kFaultReaction || now == DriveState::kNotReady) {
    return true;
  }
  for (std::size_t command = 0; command < kDriveCommands; ++command) {
    if (after(before, static_cast<DriveCommand>(command)) == now) return true;
  }
  return false;
}

void expect_allowed(const SimulatedDrive& drive, const Frame& said) {
  ASSERT_LE(said.size, Frame::kMaxSize);
  ASSERT_LE(said.id, 0x7FFU);
  ASSERT_FALSE(said.remote || said.extended || said.error);
  if (said.id == sdo_answer(drive.node())) {
    ASSERT_EQ(said.size, 8);
  }
}

TEST(DriveFuzz, AMillionFramesIntoTheDrive) {
  Chance chance(20);
  SimulatedDrive drive;
  std::array<int, kDriveStates> visits{};
  std::uint64_t answers = 0;
  for (int i = 0; i < kFrames; ++i) {
    const std::uint64_t kind = chance.below(8);
    const Frame frame = kind == 0  ? noise(chance)
                        : kind < 4 ? mutated(chance, request(chance))
                                   : mutated(chance, sensible(chance));
    DriveState before = drive.state();
    drive.receive(frame);
    ASSERT_TRUE(may_follow(before, drive.state())) << i << ": " << show(frame);
    if (chance.one_in(3)) {
      before = drive.state();
      drive.elapse(static_cast<std::int64_t>(chance.below(20 * kMillisecond)));
      const DriveState own = automatic(before);
      ASSERT_TRUE(may_follow(before, drive.state()) || drive.state() == own ||
                  drive.state() == DriveState::kFault)
          << i;
    }
    if (chance.one_in(50)) drive.set_position(static_cast<std::int64_t>(chance.below(1000)));
    // Silent on request is only undone from outside.
    if (chance.one_in(500)) drive.set_condition(Condition::kSilent, false);
    ++visits.at(static_cast<std::size_t>(drive.state()));
    const bool on = drive.state() == DriveState::kOperationEnabled ||
                    drive.state() == DriveState::kQuickStopActive;
    ASSERT_TRUE(on || drive.current() == 0) << i;
    ASSERT_LE(std::abs(drive.torque()), std::min(value(drive, 0x6072), value(drive, 0x6073))) << i;
    Frame said;
    for (; drive.take(said); ++answers) expect_allowed(drive, said);
  }
  for (const int count : visits) EXPECT_GT(count, 100);  // it has been everywhere
  EXPECT_GT(answers, 100'000U);
  EXPECT_EQ(drive.frames_refused(), 0U);
}

/// Every number within the limits of its object, whatever was written.
TEST(DriveFuzz, ValuesStayWithinTheirLimits) {
  Chance chance(21);
  SimulatedDrive drive = ready_drive();
  for (int i = 0; i < 200'000; ++i) {
    drive.receive(mutated(chance, request(chance)));
    Frame said;
    while (drive.take(said)) {
    }
    if (i % 100 != 0) continue;
    drive.set_condition(Condition::kSilent, false);
    for (std::size_t slot = 0; slot < kDriveTable.entries; ++slot) {
      const Entry& entry = kDriveTable.entry[slot];
      if (entry.type == Type::kString) continue;
      ASSERT_EQ(ObjectDictionary::check_limits(entry, drive.objects()[slot]), Abort::kNone)
          << std::hex << entry.index << ":" << int{entry.sub};
    }
  }
}

}  // namespace
}  // namespace ebac::can::drive_fuzz_test
