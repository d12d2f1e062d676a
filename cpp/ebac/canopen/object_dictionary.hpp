#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

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

/// What an electronic data sheet (CiA 306) says of an entry of another drive.
struct SheetEntry {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  Access access = Access::kRw;
  bool mappable = false;
  std::uint8_t width = 4;  // bytes, 1 to 8; 0 for text
  std::int64_t low = 0;    // as its type has them; of eight bytes they are not checked
  std::int64_t high = 0;
  std::int64_t initial = 0;
  bool has_initial = false;
  std::string text{};  // initial one
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

  /// Makes the dictionary that of a data sheet: entries it lacks are not there, entries the table
  /// lacks are numbers and texts without effect; what is constant stays so. An empty sheet leaves the
  /// table as it is.
  void describe(std::span<const SheetEntry> sheet) {
    if (sheet.empty()) return;
    described_ = true;
    hidden_.fill(true);
    for (const SheetEntry& entry : sheet) {
      const std::size_t slot = kDriveTable.slot(entry.index, entry.sub);
      if (slot == kNoSlot) {
        extra_.push_back(entry);
        continue;
      }
      hidden_[slot] = false;
      const bool constant = kDriveTable.entry[slot].access == Access::kConst;
      access_[slot] = constant && entry.access > Access::kRo ? Access::kConst : entry.access;
      unmappable_[slot] = !entry.mappable;
    }
    std::ranges::sort(extra_, {}, [](const SheetEntry& e) { return key(e.index, e.sub); });
    extra_value_.resize(extra_.size());
    for (std::size_t i = 0; i < extra_.size(); ++i) extra_value_[i] = extra_[i].initial;
    extra_stored_ = extra_value_;
  }
  bool described() const EBAC_RT { return described_; }
  bool hidden(std::size_t slot) const EBAC_RT { return hidden_[slot]; }
  Access access(std::size_t slot) const EBAC_RT {
    return described_ ? access_[slot] : kDriveTable.entry[slot].access;
  }
  bool mappable(std::size_t slot) const EBAC_RT { return !unmappable_[slot]; }

  /// The slot, or why there is none.
  Abort locate(std::uint16_t index, std::uint8_t sub, std::size_t& slot) const EBAC_RT {
    slot = kDriveTable.slot(index, sub);
    if (slot != kNoSlot && !hidden_[slot]) return Abort::kNone;
    const std::size_t object = kDriveTable.find(index);
    slot = kNoSlot;
    if (object == kNoSlot) return has_extra(index) ? Abort::kNoSub : Abort::kNoObject;
    const Object& found = kDriveTable.object[object];
    const bool shown =
        std::any_of(hidden_.begin() + found.first, hidden_.begin() + found.first + found.count,
                    [](bool hidden) { return !hidden; });
    return shown || has_extra(index) ? Abort::kNoSub : Abort::kNoObject;
  }

  /// Which entry of the data sheet alone this is, or kNoSlot.
  std::size_t extra(std::uint16_t index, std::uint8_t sub) const EBAC_RT {
    const std::size_t at = lower_extra(index, sub);
    const bool found = at < extra_.size() && extra_[at].index == index && extra_[at].sub == sub;
    return found ? at : kNoSlot;
  }
  /// All of them, in rising order.
  std::span<const SheetEntry> extras() const { return extra_; }
  const SheetEntry& extra_entry(std::size_t at) const EBAC_RT { return extra_[at]; }
  /// Copies its value to `out`; the number of bytes.
  std::size_t read_extra(std::size_t at, std::span<std::uint8_t> out) const EBAC_RT {
    const SheetEntry& entry = extra_[at];
    if (entry.width == 0) {
      const std::size_t size = std::min(entry.text.size(), out.size());
      for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(entry.text[i]);
      return size;
    }
    for (std::size_t i = 0; i < entry.width && i < out.size(); ++i) {
      out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(extra_value_[at]) >> (8 * i));
    }
    return entry.width;
  }
  Abort write_extra(std::size_t at, std::span<const std::uint8_t> bytes) EBAC_RT {
    const SheetEntry& entry = extra_[at];
    if (entry.width == 0) return Abort::kNone;  // a text is taken and not kept
    const int spare = 64 - 8 * entry.width;
    const std::uint64_t raw = get_raw(bytes, entry.width) << spare;
    const std::int64_t value = entry.low < 0 ? static_cast<std::int64_t>(raw) >> spare
                                             : static_cast<std::int64_t>(raw >> spare);
    if (spare > 0 && value > entry.high) return Abort::kTooHigh;
    if (spare > 0 && value < entry.low) return Abort::kTooLow;
    extra_value_[at] = value;
    return Abort::kNone;
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
    std::ranges::copy(extra_value_, extra_stored_.begin());
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
  void set_node(std::uint8_t node) EBAC_RT { node_ = node; }

 private:
  using Values = std::array<std::int64_t, kDriveTable.entries>;
  using Texts = std::array<Text, kTexts>;

  static constexpr std::uint32_t key(std::uint16_t index, std::uint8_t sub) EBAC_RT {
    return std::uint32_t{index} << 8U | sub;
  }
  std::size_t lower_extra(std::uint16_t index, std::uint8_t sub) const EBAC_RT {
    std::size_t low = 0;
    std::size_t high = extra_.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (key(extra_[middle].index, extra_[middle].sub) < key(index, sub)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }
  bool has_extra(std::uint16_t index) const EBAC_RT {
    const std::size_t at = lower_extra(index, 0);
    return at < extra_.size() && extra_[at].index == index;
  }
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
  bool described_ = false;
  std::array<bool, kDriveTable.entries> hidden_{};
  std::array<bool, kDriveTable.entries> unmappable_{};
  std::array<Access, kDriveTable.entries> access_{};
  std::vector<SheetEntry> extra_;
  std::vector<std::int64_t> extra_value_;
  std::vector<std::int64_t> extra_stored_;
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
  for (std::size_t i = 0; i < extra_.size(); ++i) {
    if (extra_[i].index < first || extra_[i].index > last) continue;
    extra_value_[i] = has_stored_ ? extra_stored_[i] : extra_[i].initial;
  }
}

}  // namespace ebac::can
