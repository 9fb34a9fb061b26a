#include "rig/bench/frame_data.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

using Columns = std::vector<std::vector<std::int32_t>>;

TEST(FrameData, ComesBackAsItWasPacked) {
  constexpr std::int32_t kLow = std::numeric_limits<std::int32_t>::min(),
                         kHigh = std::numeric_limits<std::int32_t>::max();
  for (const Columns& columns :
       {Columns{}, Columns{{}, {}}, Columns{{1, -1, 0, kLow, kHigh}, {256, 65536, 7, 8, 9}}})
    EXPECT_EQ(unpack_columns(pack_columns(columns)), columns);
  const Columns alike(3, std::vector<std::int32_t>(100'000, 5));  // packs away almost entirely
  EXPECT_EQ(unpack_columns(pack_columns(alike)), alike);
}

TEST(FrameData, WhatIsBrokenOrClaimsMoreThanItCanHoldIsRefused) {
  const std::vector<std::uint8_t> good = pack_columns({{1, 2, 3}, {4, 5, 6}});
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THROW(unpack_columns({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}), UserError)
        << size;
  std::vector<std::uint8_t> greedy = good;
  const std::uint32_t columns = 1000, rows = 100'000'000;  // 400 GB
  std::memcpy(greedy.data(), &columns, 4);
  std::memcpy(greedy.data() + 4, &rows, 4);
  EXPECT_THROW(unpack_columns(greedy), UserError);
  std::vector<std::uint8_t> other_size = good;
  other_size[4] = 2;
  EXPECT_THROW(unpack_columns(other_size), UserError);
}

}  // namespace
}  // namespace waverig::rig::bench
