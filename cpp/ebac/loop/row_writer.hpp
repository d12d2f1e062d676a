#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <tuple>

#include "ebac/core/fields.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/loop/row_parts.hpp"
#include "ebac/loop/trace.hpp"

namespace ebac {

/// Lays out the rows of a trace and writes them: the sample, the state of the law, then the states of `kParts` others,
/// which are given as a tuple. A part may be off, with no columns.
template <class Law, std::size_t kParts>
class RowWriter {
 public:
  /// A trace with room for `rows`; as a ring it keeps the last `rows`.
  template <class Parts>
  std::shared_ptr<Trace> make_trace(int axes, const Law& law, const Parts& parts, std::size_t rows,
                                    bool ring) {
    static_assert(std::tuple_size_v<Parts> == kParts);
    auto trace = std::make_shared<Trace>(axes);
    law_fields_ = &table_of(law);
    law_bytes_ = law_fields_->rows.empty() ? 0 : law_fields_->size;
    law_at_ = trace->add_block("law.", *law_fields_);
    std::size_t i = 0;
    std::apply([&](const auto&... part) { ((at_[i++] = add(*trace, part)), ...); }, parts);
    trace->reserve(rows, ring);
    return trace;
  }

  /// In pieces: to copy more than 272 bytes at once takes the processor a string instruction, 10 ns.
  template <class Parts>
  void write(std::byte* row, const Sample& sample, std::size_t axes, const Law& law,
             const Parts& parts) const EBAC_RT {
    std::memcpy(row, &sample, offsetof(Sample, axis));
    std::byte* to = row + offsetof(Sample, axis);
    for (std::size_t i = 0; i < axes; ++i, to += sizeof(Axis)) {
      copy_words(to + offsetof(Axis, joint), sample.axis[i].joint);
      std::memcpy(to + offsetof(Axis, port), &sample.axis[i].port, sizeof(Port));
    }
    write_law(row + law_at_, law, axes);
    std::size_t i = 0;
    std::apply([&](const auto&... part) EBAC_RT { (write_part(row + at_[i++], part, axes), ...); },
               parts);
  }

 private:
  static constexpr bool kAnyLaw = requires(const Law& law) { law.state_table(); };

  static const FieldTable& table_of(const Law& law) {
    if constexpr (kAnyLaw) {
      return law.state_table();
    } else {
      return field_table<typename Law::State>();
    }
  }

  template <class Part>
  static bool is_on(const Part& part) EBAC_RT {
    if constexpr (requires { part.on(); }) return part.on();
    return true;
  }

  template <class Part>
  static std::size_t add(Trace& trace, const Part& part) {
    if (!is_on(part)) return 0;
    return trace.add_block(std::string(Part::kPrefix), field_table<typename Part::State>());
  }

  template <class Part>
  static void write_part(std::byte* to, const Part& part, std::size_t axes) EBAC_RT {
    if (is_on(part)) copy_states(to, part, axes);
  }

  void write_law(std::byte* to, const Law& law, std::size_t axes) const EBAC_RT {
    if constexpr (!kAnyLaw) {
      copy_states(to, law, axes);
    } else if (&law.state_table() != law_fields_) {  // another law has no columns in this trace
      std::memset(to, 0, axes * law_bytes_);
    } else {
      for (std::size_t i = 0; i < axes; ++i) {
        std::memcpy(to + i * law_bytes_, law.state(i), law_bytes_);
      }
    }
  }

  std::array<std::size_t, kParts> at_{};
  std::size_t law_at_ = 0;
  std::size_t law_bytes_ = 0;               // of its state, on one axis
  const FieldTable* law_fields_ = nullptr;  // of the law that the trace was made for
};

}  // namespace ebac
