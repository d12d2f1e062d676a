#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "axes_argument.hpp"
#include "ebac/core/check.hpp"
#include "ebac/simulated_drives/wiring.hpp"
#include "zero.hpp"

namespace ebac::python {

inline can::NodeId checked_node(int node) {
  if (node < 1 || node > can::kLastNode) {
    throw std::invalid_argument(range_message("drive", "node", node, "1", 1, can::kLastNode));
  }
  return static_cast<can::NodeId>(node);
}

/// One entry of an electronic data sheet: index, sub-index, access ("ro", "wo", "rw"), whether a PDO
/// may carry it, bytes (0 for text), lowest, highest, initial value, initial text.
using SheetRow = std::tuple<std::uint16_t, std::uint8_t, std::string, bool, std::uint8_t,
                            std::int64_t, std::int64_t, std::optional<std::int64_t>, std::string>;

inline std::vector<can::SheetEntry> checked_sheet(const std::vector<SheetRow>& rows) {
  std::vector<can::SheetEntry> sheet;
  sheet.reserve(rows.size());
  for (const auto& [index, sub, access, mappable, width, low, high, initial, text] : rows) {
    if (width > 8) throw std::invalid_argument("sheet: an entry has at most 8 bytes");
    sheet.push_back({.index = index,
                     .sub = sub,
                     .access = access == "rw"   ? can::Access::kRw
                               : access == "wo" ? can::Access::kWo
                                                : can::Access::kRo,
                     .mappable = mappable,
                     .width = width,
                     .low = low,
                     .high = high,
                     .initial = initial.value_or(0),
                     .has_initial = initial.has_value(),
                     .text = text});
  }
  return sheet;
}

/// A wiring as Python gives it, one value for each axis; a list that is empty leaves the default.
struct DriveWiring {
  std::vector<int> nodes;                     // default: 1, 2, 3
  std::vector<std::vector<SheetRow>> sheets;  // default: the drive's own dictionary
  std::vector<std::int64_t> zero;             // counts
  std::vector<int> motor;                     // 1 or -1
  std::vector<int> encoder;                   // 1 or -1
};

/// A wiring that can be, with the sheets that it refers to.
class CheckedWiring {
 public:
  CheckedWiring(const DriveWiring& given, int axes) {
    if (!given.sheets.empty()) check_axes("drive.sheets", given.sheets.size(), axes);
    wiring_.zero = zero_of("drive", "zero", given.zero, axes);
    wiring_.motor = signs("motor", given.motor, axes);
    wiring_.encoder = signs("encoder", given.encoder, axes);
    nodes(given.nodes, axes);
    for (std::size_t i = 0; i < given.sheets.size(); ++i) {
      sheets_[i] = checked_sheet(given.sheets[i]);
      wiring_.sheet[i] = sheets_[i];
    }
  }
  CheckedWiring(const CheckedWiring&) = delete;  // its spans are its own
  CheckedWiring& operator=(const CheckedWiring&) = delete;

  const can::Wiring& wiring() const { return wiring_; }

 private:
  void nodes(const std::vector<int>& given, int axes) {
    if (!given.empty()) check_axes("drive.nodes", given.size(), axes);
    for (std::size_t i = 0; i < given.size(); ++i) {
      wiring_.node[i] = checked_node(given[i]);
      for (std::size_t j = 0; j < i; ++j) {
        if (given[j] == given[i]) {
          throw std::invalid_argument("drive.nodes: " + std::to_string(given[i]) +
                                      " is the id of two drives: each must have its own");
        }
      }
    }
  }
  static std::array<int, kMaxAxes> signs(const std::string& name, const std::vector<int>& given,
                                         int axes) {
    std::array<int, kMaxAxes> signs{1, 1, 1};
    if (given.empty()) return signs;
    check_axes("drive." + name, given.size(), axes);
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i] != 1 && given[i] != -1) {
        throw std::invalid_argument("drive." + name + " = " + std::to_string(given[i]) +
                                    ": must be 1 or -1");
      }
      signs[i] = given[i];
    }
    return signs;
  }

  std::array<std::vector<can::SheetEntry>, kMaxAxes> sheets_;
  can::Wiring wiring_;
};

}  // namespace ebac::python
