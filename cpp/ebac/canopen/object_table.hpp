#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "ebac/core/realtime.hpp"

/// Rows of an object dictionary: index, sub-index, name, type, access and limits.
namespace ebac::can {

/// Data types by their index in CiA 301, 7.4.7.
enum class Type : std::uint8_t {
  kNone = 0,
  kI8 = 2,
  kI16 = 3,
  kI32 = 4,
  kU8 = 5,
  kU16 = 6,
  kU32 = 7,
  kString = 9,
};

/// Bytes; a string has as many as it has.
constexpr std::uint8_t width(Type type) EBAC_RT {
  constexpr std::array<std::uint8_t, 10> kWidth{0, 0, 1, 2, 4, 1, 2, 4, 0, 0};
  return kWidth[static_cast<std::size_t>(type)];
}
constexpr bool is_signed(Type type) EBAC_RT { return type <= Type::kI32; }

constexpr std::int64_t lowest(Type type) EBAC_RT {
  return is_signed(type) ? -(std::int64_t{1} << (8 * width(type) - 1)) : 0;
}
constexpr std::int64_t highest(Type type) EBAC_RT {
  return (std::int64_t{1} << (8 * width(type) - (is_signed(type) ? 1 : 0))) - 1;
}

enum class Access : std::uint8_t { kConst, kRo, kWo, kRw };
enum class Mapping : std::uint8_t { kNo, kRpdo, kTpdo, kBoth };
enum class Shape : std::uint8_t { kNone = 0, kVar = 7, kArray = 8, kRecord = 9 };  // CiA 301, 7.4.3

struct Entry {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::string_view name;
  Type type = Type::kU32;
  Access access = Access::kRo;
  Mapping mapping = Mapping::kNo;
  std::int64_t initial = 0;  // a writable string: which of them
  std::int64_t low = 0;
  std::int64_t high = 0;
  std::string_view text;   // of a constant string
  bool plus_node = false;  // `initial` and the node's number
};

/// One index.
struct Object {
  std::uint16_t index = 0;
  std::string_view name;
  Shape shape = Shape::kVar;
  std::uint16_t first = 0;  // entry
  std::uint16_t count = 0;  // entries
};

inline constexpr std::size_t kNoSlot = std::numeric_limits<std::size_t>::max();

/// The whole table, in rising order. Made at compile time, row by row.
template <std::size_t Entries, std::size_t Objects>
struct ObjectTable {
  std::array<Entry, Entries> entry{};
  std::array<Object, Objects> object{};
  std::size_t entries = 0;
  std::size_t objects = 0;

  constexpr Entry& add(const Entry& row) {
    entry[entries] = row;
    ++object[objects - 1].count;
    Entry& made = entry[entries++];
    if (made.type != Type::kString && made.low == 0 && made.high == 0) {
      made.low = lowest(made.type);
      made.high = highest(made.type);
    }
    return made;
  }
  constexpr void open(std::uint16_t index, std::string_view name, Shape shape) {
    object[objects++] = {index, name, shape, static_cast<std::uint16_t>(entries), 0};
  }
  constexpr Entry& var(std::uint16_t index, std::string_view name, Type type, Access access,
                       std::int64_t initial = 0, Mapping mapping = Mapping::kNo) {
    open(index, name, Shape::kVar);
    return add({index, 0, name, type, access, mapping, initial, 0, 0, {}, false});
  }
  /// Opens an array or a record, whose sub-index 0 holds the highest sub-index.
  constexpr Entry& group(std::uint16_t index, std::string_view name, Shape shape,
                         std::int64_t highest_sub, Access access = Access::kConst) {
    open(index, name, shape);
    return add({index,
                0,
                "Highest sub-index",
                Type::kU8,
                access,
                Mapping::kNo,
                highest_sub,
                0,
                0,
                {},
                false});
  }
  constexpr Entry& sub(std::uint8_t sub, std::string_view name, Type type, Access access,
                       std::int64_t initial = 0) {
    return add({object[objects - 1].index,
                sub,
                name,
                type,
                access,
                Mapping::kNo,
                initial,
                0,
                0,
                {},
                false});
  }

  /// Which object has this index, or kNoSlot. No pointer: g++ 12 with sanitizers takes none at
  /// compile time.
  constexpr std::size_t find(std::uint16_t index) const EBAC_RT {
    std::size_t low = 0;
    std::size_t high = objects;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (object[middle].index < index) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low < objects && object[low].index == index ? low : kNoSlot;
  }
  /// Where the entry stands, or kNoSlot.
  constexpr std::size_t slot(std::uint16_t index, std::uint8_t sub) const EBAC_RT {
    const std::size_t found = find(index);
    if (found == kNoSlot) return kNoSlot;
    const std::size_t first = object[found].first;
    for (std::size_t slot = first; slot < first + object[found].count; ++slot) {
      if (entry[slot].sub == sub) return slot;
    }
    return kNoSlot;
  }
};

}  // namespace ebac::can
