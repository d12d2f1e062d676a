#pragma once

#include <algorithm>
#include <span>

#include "ebac/can/frame.hpp"
#include "ebac/canopen/drive_objects.hpp"
#include "ebac/canopen/sdo_abort.hpp"

namespace ebac::can {

/// A writable string.
struct Text {
  std::array<std::uint8_t, kTextRoom> byte{};
  std::uint8_t size = 0;
  std::span<const std::uint8_t> bytes() const EBAC_RT { return {byte.data(), size}; }
};

/// The values of the object table. Checks lengths and limits; their effects belong to the drive.
class ObjectDictionary {
 public:
  explicit ObjectDictionary(std::uint8_t node) : node_(node) { restore(0x1000, 0xFFFF); }

  std::int64_t operator[](std::size_t slot) const EBAC_RT { return value_[slot]; }
  std::int64_t& operator[](std::size_t slot) EBAC_RT { return value_[slot]; }

  /// A value as sent on the bus, where the object's type is wider than its use.
  template <std::uint16_t Index, std::uint8_t Sub = 0>
  std::int64_t get() const EBAC_RT {
    return value_[kAt<Index, Sub>];
  }

  /// The slot, or why there is none.
  static Abort locate(std::uint16_t index, std::uint8_t sub, std::size_t& slot) EBAC_RT {
    slot = kDriveTable.slot(index, sub);
    if (slot != kNoSlot) return Abort::kNone;
    return kDriveTable.find(index) == kNoSlot ? Abort::kNoObject : Abort::kNoSub;
  }

  /// Copies the value to `out`, little-endian; the number of bytes.
  std::size_t read(std::size_t slot, std::span<std::uint8_t> out) const EBAC_RT {
    const Entry& entry = kDriveTable.entry[slot];
    if (entry.type != Type::kString) {
      const std::size_t size = width(entry.type);
      for (std::size_t i = 0; i < size && i < out.size(); ++i) {
        out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value_[slot]) >> (8 * i));
      }
      return size;
    }
    if (entry.access == Access::kRw) {
      const auto bytes = text_[static_cast<std::size_t>(entry.initial)].bytes();
      std::copy_n(bytes.begin(), std::min(bytes.size(), out.size()), out.begin());
      return bytes.size();
    }
    const std::size_t size = std::min(entry.text.size(), out.size());
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(entry.text[i]);
    return size;
  }

  /// The number in `bytes`, with its sign, as the entry's type has it.
  static std::int64_t number(const Entry& entry, std::span<const std::uint8_t> bytes) EBAC_RT {
    const auto raw = get_raw(bytes, width(entry.type));
    const int spare = 64 - 8 * width(entry.type);
    if (!is_signed(entry.type)) return static_cast<std::int64_t>(raw);
    return static_cast<std::int64_t>(raw << spare) >> spare;
  }
  static Abort check_limits(const Entry& entry, std::int64_t value) EBAC_RT {
    if (value > entry.high) return Abort::kTooHigh;
    return value < entry.low ? Abort::kTooLow : Abort::kNone;
  }

  void set_text(const Entry& entry, std::span<const std::uint8_t> bytes) EBAC_RT {
    Text& text = text_[static_cast<std::size_t>(entry.initial)];
    text.size = static_cast<std::uint8_t>(std::min(bytes.size(), kTextRoom));
    std::copy_n(bytes.begin(), text.size, text.byte.begin());
  }

  /// Restores the power-on values of the indices `first` to `last`: stored ones, or the defaults.
  void restore(std::uint16_t first, std::uint16_t last) EBAC_RT;
  /// Values that a reset restores from now on: the present ones, or the defaults.
  void store() EBAC_RT {
    stored_ = value_;
    stored_text_ = text_;
    has_stored_ = true;
  }
  void forget() EBAC_RT { has_stored_ = false; }
  /// Makes `value` the default of an entry of this drive.
  void set_default(std::size_t slot, std::int64_t value) {
    default_[slot] = value;
    value_[slot] = value;
    changed_default_[slot] = true;
  }
  std::int64_t initial(std::size_t slot) const EBAC_RT {
    const Entry& entry = kDriveTable.entry[slot];
    if (changed_default_[slot]) return default_[slot];
    return entry.initial + (entry.plus_node ? node_ : 0);
  }
  std::uint8_t node() const EBAC_RT { return node_; }

 private:
  using Values = std::array<std::int64_t, kDriveTable.entries>;
  using Texts = std::array<Text, kTexts>;

  static std::uint64_t get_raw(std::span<const std::uint8_t> bytes, std::size_t size) EBAC_RT {
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < size && i < bytes.size(); ++i) {
      raw |= std::uint64_t{bytes[i]} << (8 * i);
    }
    return raw;
  }

  std::uint8_t node_;
  bool has_stored_ = false;
  Values value_{};
  Values default_{};
  Values stored_{};
  std::array<bool, kDriveTable.entries> changed_default_{};
  Texts text_{};
  Texts stored_text_{};
};

inline void ObjectDictionary::restore(std::uint16_t first, std::uint16_t last) EBAC_RT {
  for (std::size_t slot = 0; slot < kDriveTable.entries; ++slot) {
    const Entry& entry = kDriveTable.entry[slot];
    if (entry.index < first || entry.index > last) continue;
    const bool kept = has_stored_ && entry.access == Access::kRw;
    if (entry.type == Type::kString && entry.access == Access::kRw) {
      const auto which = static_cast<std::size_t>(entry.initial);
      text_[which] = kept ? stored_text_[which] : Text{};
    } else {
      value_[slot] = kept ? stored_[slot] : initial(slot);
    }
  }
}

}  // namespace ebac::can
