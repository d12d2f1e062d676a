#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "ebac/loop/trace.hpp"

namespace ebac {

/// Every value of every column of `wanted` stands in `got`, to the bit.
inline void expect_same_bits(const Trace& got, const Trace& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  std::size_t compared = 0;
  for (const Column& column : wanted.columns()) {
    const auto& all = got.columns();
    const auto same = std::ranges::find(all, column.name, &Column::name);
    ASSERT_NE(same, all.end()) << column.name;
    const std::size_t bytes = column.kind == 'w' || column.kind == 'u' ? 4
                              : column.kind == 'b'                     ? 1
                                                                       : 8;
    const int axes = column.stride > 0 ? wanted.axes() : 1;
    for (std::size_t row = 0; row < wanted.size(); ++row) {
      for (std::size_t axis = 0; axis < static_cast<std::size_t>(axes); ++axis, ++compared) {
        const std::byte* a =
            got.data() + row * got.row_bytes() + same->offset + axis * same->stride;
        const std::byte* b =
            wanted.data() + row * wanted.row_bytes() + column.offset + axis * column.stride;
        ASSERT_EQ(std::memcmp(a, b, bytes), 0)
            << column.name << ", row " << row << ", axis " << axis;
      }
    }
  }
  EXPECT_GT(compared, 20 * wanted.size());
}

}  // namespace ebac
