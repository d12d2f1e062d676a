#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ebac/loop/trace.hpp"

namespace ebac::trace_ring_test {
namespace {

/// A state whose size is no multiple of a word.
struct Odd {
  bool flag = false;
  static constexpr auto fields() {
    return std::array{Field<Odd>{"flag", &Odd::flag, "1", "a flag"}};
  }
};

/// Appends row `n`: every word of it says n.
void append(Trace& trace, std::uint64_t n) {
  std::byte* row = trace.next();
  ASSERT_NE(row, nullptr);
  for (std::size_t at = 0; at < trace.row_bytes(); at += sizeof n)
    std::memcpy(row + at, &n, sizeof n);
  trace.commit();
}

/// What row `i` of copied rows says, or -1 when its words disagree.
std::int64_t said(const Trace& trace, const std::vector<std::byte>& rows, std::size_t i) {
  std::uint64_t first = 0;
  std::memcpy(&first, rows.data() + i * trace.row_bytes(), sizeof first);
  for (std::size_t at = 0; at < trace.row_bytes(); at += sizeof first) {
    std::uint64_t word = 0;
    std::memcpy(&word, rows.data() + i * trace.row_bytes() + at, sizeof word);
    if (word != first) return -1;
  }
  return static_cast<std::int64_t>(first);
}

Trace odd_trace(std::size_t rows, bool ring) {
  Trace layout(1);
  layout.add_block("odd.", field_table<Odd>());
  return {layout, rows, ring};
}

TEST(TraceRing, RowsAreWholeWords) {
  const Trace trace = odd_trace(4, true);
  EXPECT_EQ(trace.row_bytes() % sizeof(std::uint64_t), 0u);
}

TEST(TraceRing, KeepsTheLastRowsAndSaysWhatIsGone) {
  Trace trace = odd_trace(4, true);
  for (std::uint64_t n = 0; n < 10; ++n) append(trace, n);
  EXPECT_EQ(trace.size(), 10u);
  EXPECT_EQ(trace.first(), 6u);
  std::vector<std::byte> rows(6 * trace.row_bytes());
  EXPECT_EQ(trace.copy(4, rows), 2u);
  for (std::size_t i = 2; i < 6; ++i) EXPECT_EQ(said(trace, rows, i), static_cast<int>(4 + i));
  EXPECT_EQ(trace.sample(9).tick, 9);
}

TEST(TraceRing, AFixedTraceIsFullAndLosesNothing) {
  Trace trace = odd_trace(3, false);
  for (std::uint64_t n = 0; n < 3; ++n) append(trace, n);
  EXPECT_EQ(trace.next(), nullptr);
  EXPECT_EQ(trace.first(), 0u);
  std::vector<std::byte> rows(3 * trace.row_bytes());
  EXPECT_EQ(trace.copy(0, rows), 0u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(said(trace, rows, i), static_cast<int>(i));
}

TEST(TraceRing, RowsThatAreNotThereAreNotRead) {
  for (const bool ring : {false, true}) {
    Trace trace = odd_trace(3, ring);
    for (std::uint64_t n = 0; n < 2; ++n) append(trace, n);
    const std::size_t row = trace.row_bytes();
    std::vector<std::byte> rows(20 * row, std::byte{0xAB});
    EXPECT_EQ(trace.copy(1, rows), 0u);
    EXPECT_EQ(said(trace, rows, 0), 1);
    EXPECT_EQ(rows[row], std::byte{0xAB}) << ring;
    rows.assign(rows.size(), std::byte{0xAB});
    EXPECT_EQ(trace.copy(1'000'000, rows), 0u);
    EXPECT_EQ(trace.copy(SIZE_MAX - 1, rows), 0u);
    EXPECT_EQ(rows[0], std::byte{0xAB}) << ring;
    EXPECT_EQ(trace.sample(1).tick, 1);
    EXPECT_EQ(trace.sample(1'000'000).tick, 0);
  }
}

TEST(TraceRing, MoreRowsThanMemoryCanHaveAreRefused) {
  for (const bool ring : {false, true}) {
    for (const std::size_t rows : {SIZE_MAX, SIZE_MAX / 8 + 1, SIZE_MAX / 64 + 1}) {
      EXPECT_THROW(odd_trace(rows, ring), std::length_error) << rows << " " << ring;
    }
  }
}

/// A reader beside a loop that never waits: each row it is given is whole and is the one it asked
/// for, and rows read and rows lost add up.
TEST(TraceRing, AReaderNeverGetsATornRow) {
  constexpr std::uint64_t kRows = 200'000;
  Trace trace = odd_trace(64, true);
  std::thread loop([&] {
    for (std::uint64_t n = 0; n < kRows; ++n) append(trace, n);
  });
  std::size_t seen = 0;
  std::size_t read = 0;
  std::size_t lost = 0;
  std::vector<std::byte> rows;
  while (seen < kRows) {
    const std::size_t end = trace.size();
    const std::size_t from = std::max(seen, end > 64 ? end - 64 : 0);
    lost += from - seen;
    rows.resize((end - from) * trace.row_bytes());
    const std::size_t gone = trace.copy(from, rows);
    lost += gone;
    for (std::size_t i = gone; i < end - from; ++i) {
      ASSERT_EQ(said(trace, rows, i), static_cast<std::int64_t>(from + i));
      ++read;
    }
    seen = end;
  }
  loop.join();
  EXPECT_EQ(read + lost, kRows);
  EXPECT_GT(read, 0u);
}

}  // namespace
}  // namespace ebac::trace_ring_test
