#include "ebac/loop/trace.hpp"

#include <stdexcept>

namespace ebac {

Trace::Trace(int axes) : axes_(axes) {
  add("", field_table<Sample>(), 0, 0);
  const std::size_t first = offsetof(Sample, axis);
  add("", field_table<Joint>(), first + offsetof(Axis, joint), sizeof(Axis));
  add("", field_table<Port>(), first + offsetof(Axis, port), sizeof(Axis));
  add("est.", field_table<Estimate>(), first + offsetof(Axis, port) + offsetof(Port, est),
      sizeof(Axis));
  row_ = first + sizeof(Axis) * static_cast<std::size_t>(axes);
}

Trace::Trace(const Trace& layout, std::size_t rows, bool ring)
    : axes_(layout.axes_), columns_(layout.columns_), row_(layout.row_) {
  reserve(rows, ring);
}

std::size_t Trace::add_block(const std::string& prefix, const FieldTable& table) {
  const std::size_t at = row_;
  if (table.rows.empty()) return at;
  add(prefix, table, at, table.size);
  row_ += table.size * static_cast<std::size_t>(axes_);
  return at;
}

void Trace::reserve(std::size_t rows, bool ring) {
  row_ = (row_ + sizeof(Word) - 1) / sizeof(Word) * sizeof(Word);
  if (rows >= data_.max_size() / words()) throw std::length_error("Trace: too many rows");
  capacity_ = rows;
  ring_ = ring;
  data_.resize((ring ? rows + 1 : rows) * words());  // one more: the row that is being written
  staged_.resize(ring ? words() : 0);
}

void Trace::add(const std::string& prefix, const FieldTable& table, std::size_t base,
                std::size_t stride) {
  for (const FieldRow& field : table.rows) {
    columns_.push_back({prefix + std::string(field.name), std::string(field.unit),
                        std::string(field.meaning), static_cast<char>(field.kind),
                        base + field.offset, stride});
  }
}

}  // namespace ebac
