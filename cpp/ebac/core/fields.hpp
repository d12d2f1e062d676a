#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <variant>

namespace ebac {

enum class Fault : std::uint32_t;

inline constexpr double kAnyLow = -std::numeric_limits<double>::infinity();
inline constexpr double kAnyHigh = std::numeric_limits<double>::infinity();

/// One member of an aggregate: the single description behind bindings, logs, repr, documentation
/// and range errors.
template <class Owner>
struct Field {
  using Member = std::variant<double Owner::*, int Owner::*, bool Owner::*, std::int64_t Owner::*,
                              Fault Owner::*>;
  std::string_view name;
  Member member;
  std::string_view unit;     // "1" for a pure number
  std::string_view meaning;  // one sentence, no full stop
  double low = kAnyLow;      // smallest value allowed
  double high = kAnyHigh;    // largest value allowed
};

/// An aggregate with a list of its fields: `static constexpr auto fields()`, an array of Field<T>.
template <class T>
concept Described = requires { T::fields().size(); };

/// Type of a field.
enum class FieldKind : char { kDouble = 'f', kInt64 = 'i', kInt = 'w', kFault = 'u', kBool = 'b' };

/// A field without the type of its owner: its place is an offset in bytes.
struct FieldRow {
  std::string_view name;
  std::string_view unit;
  std::string_view meaning;
  FieldKind kind = FieldKind::kDouble;
  std::size_t offset = 0;  // bytes
  double low = kAnyLow;
  double high = kAnyHigh;

  template <class T>
  const T& in(const void* owner) const {
    return *reinterpret_cast<const T*>(static_cast<const std::byte*>(owner) + offset);
  }
  template <class T>
  T& in(void* owner) const {
    return *reinterpret_cast<T*>(static_cast<std::byte*>(owner) + offset);
  }
  /// The value in `owner` as a number.
  double number(const void* owner) const;
};

/// The fields of a type without the type: what can be compiled once for all of them.
struct FieldTable {
  std::span<const FieldRow> rows;
  std::size_t size = 0;           // bytes of the owner
  const void* initial = nullptr;  // an owner with the default of every field

  /// The field of that name, or nullptr.
  const FieldRow* find(std::string_view name) const;
};

/// The table of T, made at its first use.
template <Described T>
const FieldTable& field_table() {
  constexpr std::size_t kCount = T::fields().size();
  static const T kInitial{};
  static const std::array<FieldRow, kCount> kRows = [] {
    std::array<FieldRow, kCount> all{};  // NOLINT(bugprone-invalid-enum-default-initialization)
    const auto fields = T::fields();
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto& field = fields[i];
      all[i] = {field.name, field.unit, field.meaning, FieldKind::kDouble,
                0,          field.low,  field.high};
      const auto place = [&](FieldKind kind, const void* at) {
        all[i].kind = kind;
        all[i].offset = static_cast<std::size_t>(static_cast<const std::byte*>(at) -
                                                 reinterpret_cast<const std::byte*>(&kInitial));
      };
      switch (field.member.index()) {
        case 0:
          place(FieldKind::kDouble, &(kInitial.**std::get_if<0>(&field.member)));
          break;
        case 1:
          place(FieldKind::kInt, &(kInitial.**std::get_if<1>(&field.member)));
          break;
        case 2:
          place(FieldKind::kBool, &(kInitial.**std::get_if<2>(&field.member)));
          break;
        case 3:
          place(FieldKind::kInt64, &(kInitial.**std::get_if<3>(&field.member)));
          break;
        default:
          place(FieldKind::kFault, &(kInitial.**std::get_if<4>(&field.member)));
      }
    }
    return all;
  }();
  static const FieldTable kTable{kRows, sizeof(T), &kInitial};
  return kTable;
}

}  // namespace ebac
