#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "ebac/core/sample.hpp"

namespace ebac {

/// One named column of a trace: where its numbers lie in a row.
struct Column {
  std::string name;
  std::string unit;
  std::string meaning;
  char kind;           // 'f' double, 'i' int64, 'w' int32, 'u' uint32, 'b' bool
  std::size_t offset;  // bytes, of the first axis
  std::size_t stride;  // bytes from axis to axis; 0 for a column of the whole row

  bool operator==(const Column&) const = default;
};

/// The rows of a run, preallocated. A row is the used prefix of a Sample, then the law's state of
/// each axis, then the columns of the device. Appending is a copy and one release store; readers
/// may read while it grows.
///
/// As a ring it never fills up and keeps the last rows: for runs of any length, whose rows a
/// recorder writes to disk. A reader copies rows and learns which of them were overwritten before
/// the copy.
class Trace {
 public:
  /// A trace without rows; `reserve` fixes the layout and makes room.
  explicit Trace(int axes);

  /// No rows yet, in the layout of another trace.
  Trace(const Trace& layout, std::size_t rows, bool ring);

  /// Appends a block of such fields per axis to the row; its columns are called prefix + field name.
  /// Returns where it begins.
  std::size_t add_block(const std::string& prefix, const FieldTable& table);

  /// Room for `rows` rows; as a ring for the last `rows`. Throws std::length_error for more than there can be.
  void reserve(std::size_t rows, bool ring = false);

  /// Where the next row goes, or nullptr when the trace is full; `commit` makes it visible.
  std::byte* next() EBAC_RT {
    if (ring_) return reinterpret_cast<std::byte*>(staged_.data());
    const std::size_t n = count_.load(std::memory_order_relaxed);
    return n < capacity_ ? bytes() + n * row_ : nullptr;
  }
  void commit() EBAC_RT {
    const std::size_t n = count_.load(std::memory_order_relaxed);
    if (ring_) publish(n);
    count_.store(n + 1, std::memory_order_release);
  }

  /// Rows appended since the start; a ring still has those from `first()` on.
  std::size_t size() const EBAC_RT { return count_.load(std::memory_order_acquire); }
  std::size_t first() const EBAC_RT {
    const std::size_t n = size();
    return n > capacity_ ? n - capacity_ : 0;
  }
  bool ring() const { return ring_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t row_bytes() const { return row_; }
  int axes() const { return axes_; }
  const std::vector<Column>& columns() const { return columns_; }
  /// The rows as they lie; of a ring, use `copy`.
  const std::byte* data() const { return reinterpret_cast<const std::byte*>(data_.data()); }

  /// Copies rows `from`, `from` + 1, ... to `out`, as many as fit in it and are below `size()`; beyond
  /// them `out` stays as it is. Returns how many of the first rows were overwritten before or during
  /// the copy: their content in `out` is invalid.
  std::size_t copy(std::size_t from, std::span<std::byte> out) const EBAC_RT {
    const std::size_t n = size();  // once: it grows
    const std::size_t rows = std::min(out.size() / row_, n - std::min(from, n));
    if (rows == 0) return 0;
    if (ring_) {
      for (std::size_t i = 0; i < rows; ++i) take(from + i, out.data() + i * row_, row_);
    } else {
      std::memcpy(out.data(), data() + from * row_, rows * row_);
    }
    return std::clamp(first(), from, from + rows) - from;
  }

  /// The sample of row `i`; axes beyond the ones in use are zero. That of a row that is not there yet is as it begins.
  Sample sample(std::size_t i) const {
    Sample s;
    if (i >= size()) return s;
    const std::size_t size =
        offsetof(Sample, axis) + sizeof(Axis) * static_cast<std::size_t>(axes_);
    if (ring_) {
      take(i, reinterpret_cast<std::byte*>(&s), size);
    } else {
      std::memcpy(static_cast<void*>(&s), data() + i * row_, size);
    }
    return s;
  }

 private:
  void add(const std::string& prefix, const FieldTable& table, std::size_t base,
           std::size_t stride);

  using Word = std::uint64_t;

  std::size_t words() const EBAC_RT { return row_ / sizeof(Word); }
  std::byte* bytes() EBAC_RT { return reinterpret_cast<std::byte*>(data_.data()); }
  std::size_t slot(std::size_t row) const EBAC_RT { return row % (capacity_ + 1) * words(); }

  /// Word by word, released: a reader that sees a word of row n also sees that n rows are complete,
  /// and so knows that the row it wanted is gone.
  void publish(std::size_t row) EBAC_RT {
    Word* to = data_.data() + slot(row);
    for (std::size_t i = 0; i < words(); ++i) {
      std::atomic_ref(to[i]).store(staged_[i], std::memory_order_release);
    }
  }
  /// The first `size` bytes of a row, whole words.
  void take(std::size_t row, std::byte* out, std::size_t size) const EBAC_RT {
    static_assert(offsetof(Sample, axis) % sizeof(Word) == 0 && sizeof(Axis) % sizeof(Word) == 0);
    Word* from = data_.data() + slot(row);
    for (std::size_t i = 0; i < size / sizeof(Word); ++i) {
      const Word word = std::atomic_ref(from[i]).load(std::memory_order_acquire);
      std::memcpy(out + i * sizeof(Word), &word, sizeof(Word));
    }
  }

  int axes_;
  std::vector<Column> columns_;
  std::size_t row_ = 0;  // bytes, in whole words
  std::size_t capacity_ = 0;
  bool ring_ = false;
  mutable std::vector<Word> data_;  // mutable: an atomic look at a word takes it as one to write
  std::vector<Word> staged_;        // the row a ring takes next
  std::atomic<std::size_t> count_{0};
};

}  // namespace ebac
