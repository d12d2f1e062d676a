#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace ebac {

enum class Fault : std::uint32_t;

inline constexpr double kAnyLow = -std::numeric_limits<double>::infinity();
inline constexpr double kAnyHigh = std::numeric_limits<double>::infinity();

/// Type of a field.
enum class FieldKind : char { kDouble = 'f', kInt64 = 'i', kInt = 'w', kFault = 'u', kBool = 'b' };

/// Which member of an aggregate. A variant would say the same and take a compiler 17 ms more for each aggregate, in
/// every file that includes it.
template <class Owner>
class FieldMember {
 public:
  constexpr FieldMember(double Owner::* at) : kind_(FieldKind::kDouble), number(at) {}
  constexpr FieldMember(int Owner::* at) : kind_(FieldKind::kInt), whole(at) {}
  constexpr FieldMember(bool Owner::* at) : kind_(FieldKind::kBool), flag(at) {}
  constexpr FieldMember(std::int64_t Owner::* at) : kind_(FieldKind::kInt64), longer(at) {}
  constexpr FieldMember(Fault Owner::* at) : kind_(FieldKind::kFault), fault(at) {}

  constexpr FieldKind kind() const { return kind_; }

  /// Where it lies in `owner`.
  const void* in(const Owner& owner) const {
    switch (kind_) {
      case FieldKind::kDouble:
        return &(owner.*number);
      case FieldKind::kInt:
        return &(owner.*whole);
      case FieldKind::kBool:
        return &(owner.*flag);
      case FieldKind::kInt64:
        return &(owner.*longer);
      case FieldKind::kFault:
        break;
    }
    return &(owner.*fault);
  }

 private:
  FieldKind kind_;
  union {
    double Owner::* number;
    int Owner::* whole;
    bool Owner::* flag;
    std::int64_t Owner::* longer;
    Fault Owner::* fault;
  };
};

/// One member of an aggregate: the single description behind bindings, logs, repr, documentation
/// and range errors.
template <class Owner>
struct Field {
  std::string_view name;
  FieldMember<Owner> member;
  std::string_view unit;     // "1" for a pure number
  std::string_view meaning;  // one sentence, no full stop
  double low = kAnyLow;      // smallest value allowed
  double high = kAnyHigh;    // largest value allowed
};

/// An aggregate with a list of its fields: `static constexpr auto fields()`, an array of Field<T>.
template <class T>
concept Described = requires { T::fields().size(); };

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
      const auto* at = static_cast<const std::byte*>(field.member.in(kInitial));
      all[i] = {field.name,
                field.unit,
                field.meaning,
                field.member.kind(),
                static_cast<std::size_t>(at - reinterpret_cast<const std::byte*>(&kInitial)),
                field.low,
                field.high};
    }
    return all;
  }();
  static const FieldTable kTable{kRows, sizeof(T), &kInitial};
  return kTable;
}

}  // namespace ebac
