#pragma once

#include <atomic>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
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
};

/// The rows of a run, preallocated. A row is the used prefix of a Sample, then the law's state of
/// each axis, then what the device adds. Appending is a copy and one release store; readers may
/// look on while it grows.
class Trace {
 public:
  /// A trace without rows; `reserve` fixes the layout and makes room.
  explicit Trace(int axes) : axes_(axes) {
    add<Sample>("", 0, 0);
    const std::size_t first = offsetof(Sample, axis);
    add<Joint>("", first + offsetof(Axis, joint), sizeof(Axis));
    add<Port>("", first + offsetof(Axis, port), sizeof(Axis));
    row_ = first + sizeof(Axis) * static_cast<std::size_t>(axes);
  }

  /// Appends a block of T per axis to the row; its columns are called prefix + field name.
  template <Described T>
  std::size_t add_block(const std::string& prefix) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(double));
    const std::size_t at = row_;
    if (T::fields().size() == 0) return at;
    add<T>(prefix, at, sizeof(T));
    row_ += sizeof(T) * static_cast<std::size_t>(axes_);
    return at;
  }

  void reserve(std::size_t rows) {
    capacity_ = rows;
    data_.resize(rows * row_);
  }

  /// Where the next row goes, or nullptr when the trace is full; `commit` makes it visible.
  std::byte* next() EBAC_RT {
    const std::size_t n = count_.load(std::memory_order_relaxed);
    return n < capacity_ ? data_.data() + n * row_ : nullptr;
  }
  void commit() EBAC_RT {
    count_.store(count_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  std::size_t size() const EBAC_RT { return count_.load(std::memory_order_acquire); }
  std::size_t row_bytes() const { return row_; }
  int axes() const { return axes_; }
  const std::vector<Column>& columns() const { return columns_; }
  const std::byte* data() const { return data_.data(); }

  /// The sample of row `i`; axes beyond the ones in use are zero.
  Sample sample(std::size_t i) const {
    Sample s;
    std::memcpy(static_cast<void*>(&s), data_.data() + i * row_,
                offsetof(Sample, axis) + sizeof(Axis) * static_cast<std::size_t>(axes_));
    return s;
  }

 private:
  template <Described T>
  void add(const std::string& prefix, std::size_t base, std::size_t stride) {
    static const T kZero{};
    for (const auto& field : T::fields()) {
      std::visit(
          [&](auto member) {
            using Value = std::remove_cvref_t<decltype(kZero.*member)>;
            const auto* at = reinterpret_cast<const std::byte*>(&(kZero.*member));
            const auto inside =
                static_cast<std::size_t>(at - reinterpret_cast<const std::byte*>(&kZero));
            columns_.push_back({prefix + std::string(field.name), std::string(field.unit),
                                std::string(field.meaning), kind_of<Value>(), base + inside,
                                stride});
          },
          field.member);
    }
  }

  template <class Value>
  static constexpr char kind_of() {
    if constexpr (std::is_same_v<Value, double>) return 'f';
    if constexpr (std::is_same_v<Value, std::int64_t>) return 'i';
    if constexpr (std::is_same_v<Value, int>) return 'w';
    if constexpr (std::is_same_v<Value, Fault>) return 'u';
    if constexpr (std::is_same_v<Value, bool>) return 'b';
  }

  int axes_;
  std::vector<Column> columns_;
  std::size_t row_ = 0;
  std::size_t capacity_ = 0;
  std::vector<std::byte> data_;
  std::atomic<std::size_t> count_{0};
};

}  // namespace ebac
