#include "rig/frontend/frame_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "motion/kinematics/random.h"

namespace waverig::rig {
namespace {

using Bytes = std::vector<std::uint8_t>;

const FrameLayout& layout() { return default_frame_layout(); }

// Frames of random content, the counter growing from `first`.
std::vector<Bytes> frames_of(std::int64_t first, int count, std::uint64_t seed = 1) {
  const FrameEncoder encoder(layout());
  RandomStream random(seed, "frames");
  std::vector<Bytes> frames;
  for (int n = 0; n < count; ++n) {
    std::vector<std::int64_t> raw(layout().fields.size());
    for (auto& r : raw) r = static_cast<std::int64_t>(random.bits());
    raw[0] = first + n;
    frames.emplace_back();
    encoder.append(raw, frames.back());
  }
  return frames;
}

std::vector<std::int64_t> counters(FrameDecoder& decoder, std::span<const std::uint8_t> bytes) {
  std::vector<std::int64_t> found;
  decoder.add(bytes);
  while (const Frame* frame = decoder.next()) found.push_back(frame->raw[0]);
  return found;
}

Bytes joined(const std::vector<Bytes>& frames) {
  Bytes all;
  for (const Bytes& f : frames) all.insert(all.end(), f.begin(), f.end());
  return all;
}

TEST(FrameCodec, GivesBackEveryFieldOfAnyTypePlaceAndOrder) {
  FrameLayout l;
  l.length_bytes = 64;
  l.sync = {0x7E};
  l.crc = CrcPlacement{{}, 0, 61, 62, ByteOrder::kLittle};
  RandomStream random(3, "fields");
  int bit = 8;
  while (bit < 8 * 60) {  // fields of all widths, one after the other, in alternating order
    FrameField f;
    f.name = std::to_string(bit);
    f.bits = std::min(1 + static_cast<int>(random.uniform(0, 57)), 8 * 62 - bit);
    f.bit_offset = bit;
    f.type = random.uniform() < 0.5 ? FieldType::kSigned : FieldType::kUnsigned;
    f.order = (bit / 8) % 2 == 0 ? ByteOrder::kBig : ByteOrder::kLittle;
    if (f.order == ByteOrder::kLittle && f.bit_offset % 8 != 0) f.order = ByteOrder::kBig;
    bit += f.bits;
    if (f.order == ByteOrder::kLittle)
      bit = (bit + 7) / 8 * 8;  // the other order counts from the other end
    else if (random.uniform() < 0.3)
      bit = (bit + 7) / 8 * 8;
    l.fields.push_back(f);
  }
  ASSERT_GT(l.fields.size(), 10U);
  const FrameEncoder encoder(l);
  FrameDecoder decoder(l);
  for (int run = 0; run < 200; ++run) {
    std::vector<std::int64_t> raw;
    for (const FrameField& f : l.fields) {
      const std::uint64_t word = random.bits() >> (64 - f.bits);
      raw.push_back(f.type == FieldType::kSigned && (word >> (f.bits - 1)) != 0
                        ? static_cast<std::int64_t>(word | (~std::uint64_t{0} << (f.bits - 1)))
                        : static_cast<std::int64_t>(word));
    }
    Bytes bytes;
    encoder.append(raw, bytes);
    decoder.add(bytes);
    const Frame* frame = decoder.next();
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->raw, raw);
    EXPECT_EQ(frame->sequence, run);
  }
}

TEST(FrameCodec, StandsOnTheWireAsTheLayoutSays) {
  FrameLayout l;
  l.length_bytes = 6;
  l.sync = {0xAA};
  l.terminator = {0x0D};
  FrameField big{.name = "big", .bit_offset = 8, .bits = 12};
  FrameField little{.name = "little", .bit_offset = 24, .bits = 12, .order = ByteOrder::kLittle};
  l.fields = {big, little};
  Bytes bytes;
  FrameEncoder(l).append(std::vector<std::int64_t>{0xABC, 0x123}, bytes);
  EXPECT_EQ(bytes, (Bytes{0xAA, 0xAB, 0xC0, 0x23, 0x01, 0x0D}));
}

TEST(FrameDecoder, DoesNotCareHowTheBytesArrive) {
  const Bytes all = joined(frames_of(65530, 20));  // over the counter's wrap
  for (std::size_t piece = 1; piece < 100; piece += 7) {
    FrameDecoder decoder(layout());
    std::int64_t n = 0;
    for (std::size_t at = 0; at < all.size(); at += piece) {
      decoder.add(std::span(all).subspan(at, std::min(piece, all.size() - at)));
      while (const Frame* frame = decoder.next()) {
        EXPECT_EQ(frame->sequence, n);
        EXPECT_EQ(frame->missing, 0);
        EXPECT_EQ(frame->raw[0], (65530 + n) % 65536);
        ++n;
      }
    }
    EXPECT_EQ(n, 20);
    EXPECT_EQ(decoder.statistics().skipped_bytes, 0);
  }
}

TEST(FrameDecoder, CountsWhatIsMissing) {
  auto frames = frames_of(0, 20);
  frames.erase(frames.begin() + 5, frames.begin() + 9);
  FrameDecoder decoder(layout());
  decoder.add(joined(frames));
  std::vector<std::int64_t> missing, sequence;
  while (const Frame* frame = decoder.next()) {
    missing.push_back(frame->missing);
    sequence.push_back(frame->sequence);
  }
  ASSERT_EQ(missing.size(), 16U);
  EXPECT_EQ(missing[5], 4);
  EXPECT_EQ(sequence[5], 9);
  EXPECT_EQ(std::ranges::count(missing, 0), 15);
  EXPECT_EQ(decoder.statistics().lost, 4);
}

TEST(FrameDecoder, LosesNoIntactFrameAtFivePercentCorruptedFramesOfEveryKind) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, "corruption");
    Bytes wire;
    std::vector<std::int64_t> intact;
    std::int64_t n = 0;
    for (Bytes& frame : frames_of(0, 3000, seed)) {
      if (random.uniform() < 0.05) {
        const auto at = static_cast<std::size_t>(random.uniform(0, static_cast<double>(frame.size())));
        const double kind = random.uniform();
        if (kind < 0.5)
          frame[at] ^= static_cast<std::uint8_t>(1 + random.bits() % 255);  // a wrong byte
        else if (kind < 0.75)
          frame.erase(frame.begin() + static_cast<std::ptrdiff_t>(at));  // a lost one
        else
          frame.resize(at);                                           // cut short
        if (kind > 0.9) wire.insert(wire.end(), {0xEB, 0x90, 0x00});  // and a false beginning
      } else {
        intact.push_back(n);
      }
      wire.insert(wire.end(), frame.begin(), frame.end());
      ++n;
    }
    FrameDecoder decoder(layout());
    EXPECT_EQ(counters(decoder, wire), intact);
    EXPECT_EQ(decoder.statistics().bytes, static_cast<std::int64_t>(wire.size()));
  }
}

TEST(FrameDecoder, LosesNoIntactFrameAtFivePercentCorruptedBytes) {
  RandomStream random(5, "bytes");
  Bytes wire;
  std::vector<std::int64_t> intact;
  std::int64_t n = 0;
  for (Bytes& frame : frames_of(0, 20000)) {
    bool hit = false;
    for (auto& byte : frame)
      if (random.uniform() < 0.05) {
        byte ^= static_cast<std::uint8_t>(1 + random.bits() % 255);
        hit = true;
      }
    if (!hit) intact.push_back(n);
    wire.insert(wire.end(), frame.begin(), frame.end());
    ++n;
  }
  FrameDecoder decoder(layout());
  EXPECT_EQ(counters(decoder, wire), intact);
  EXPECT_LT(intact.size(), 4000U);  // about 0.95^40 of them
}

TEST(FrameDecoder, DropsAFrameWhoseCounterTheNextOneDoesNotBearOut) {
  auto frames = frames_of(100, 10);
  frames.insert(frames.begin() + 5, frames_of(40000, 1)[0]);  // as a broken frame that its CRC let pass
  FrameDecoder decoder(layout());
  const auto found = counters(decoder, joined(frames));
  EXPECT_EQ(found.size(), 10U);
  EXPECT_EQ(std::ranges::count(found, 40000), 0);
  EXPECT_EQ(decoder.statistics().unconfirmed, 1);
  EXPECT_EQ(decoder.statistics().lost, 0);
}

TEST(FrameDecoder, DropsWildFramesThatDoNotBearEachOtherOut) {
  auto frames = frames_of(100, 10);
  frames.insert(frames.begin() + 5, frames_of(20000, 1)[0]);
  frames.insert(frames.begin() + 5, frames_of(40000, 1)[0]);
  FrameDecoder decoder(layout());
  EXPECT_EQ(counters(decoder, joined(frames)).size(), 10U);
  EXPECT_EQ(decoder.statistics().unconfirmed, 2);
}

// Of sixteen numbers half are behind: a jump of nine says nothing.
TEST(FrameDecoder, BelievesANarrowCounterNoLongGap) {
  FrameLayout l;
  l.length_bytes = 3;
  l.sync = {0xAA};
  l.terminator = {0x0D};
  l.fields = {{.name = "n", .type = FieldType::kUnsigned, .bit_offset = 8, .bits = 4}};
  l.counter = "n";
  const FrameEncoder encoder(l);
  Bytes wire;
  for (const std::int64_t n : {0, 1, 2, 11, 3, 4}) encoder.append(std::vector<std::int64_t>{n}, wire);
  FrameDecoder decoder(l);
  EXPECT_EQ(counters(decoder, wire), (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(decoder.statistics().unconfirmed, 1);
}

TEST(FrameDecoder, WithoutACrcHoldsTheFrameAgainstItsTerminator) {
  FrameLayout l;
  l.length_bytes = 4;
  l.sync = {0xAA};
  l.terminator = {0x0D, 0x0A};
  l.fields = {{.name = "x", .type = FieldType::kUnsigned, .bit_offset = 8, .bits = 8}};
  FrameDecoder decoder(l);
  EXPECT_EQ(counters(decoder, Bytes{0xAA, 1, 0x0D, 0x0A, 0xAA, 2, 0x0D, 0x0B, 0xAA, 3, 0x0D, 0x0A}),
            (std::vector<std::int64_t>{1, 3}));
  EXPECT_EQ(decoder.statistics().broken, 1);
}

TEST(FrameDecoder, FollowsAUnitThatStartsAnew) {
  auto frames = frames_of(30000, 5);
  for (const Bytes& f : frames_of(0, 5)) frames.push_back(f);
  FrameDecoder decoder(layout());
  EXPECT_EQ(counters(decoder, joined(frames)),
            (std::vector<std::int64_t>{30000, 30001, 30002, 30003, 30004, 0, 1, 2, 3, 4}));
  EXPECT_EQ(decoder.statistics().restarts, 1);
}

TEST(FrameDecoder, DropsRepeatedFrames) {
  auto frames = frames_of(0, 5);
  frames.insert(frames.begin() + 3, frames[2]);
  FrameDecoder decoder(layout());
  EXPECT_EQ(counters(decoder, joined(frames)), (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(decoder.statistics().duplicates, 1);
}

TEST(FrameDecoder, BelievesAFirstFrameInMidStreamOnlyWithASecond) {
  const Bytes all = joined(frames_of(7, 3));
  FrameDecoder decoder(layout());
  const auto tail = std::span(all).subspan(3);
  EXPECT_TRUE(counters(decoder, tail.first(2 * 40 - 3)).empty());
  EXPECT_EQ(counters(decoder, tail.subspan(2 * 40 - 3)), (std::vector<std::int64_t>{8, 9}));
}

TEST(FrameDecoder, SurvivesNoise) {
  RandomStream random(9, "noise");
  FrameDecoder decoder(layout());
  Bytes noise(1000);
  for (int run = 0; run < 1000; ++run) {
    for (auto& byte : noise) {
      const double kind = random.uniform();  // sync bytes far more often than chance has them
      byte = kind < 0.1 ? 0xEB : kind < 0.2 ? 0x90 : static_cast<std::uint8_t>(random.bits());
    }
    const auto size = static_cast<std::size_t>(random.uniform(0, 1000));
    counters(decoder, std::span(noise).first(size));
  }
  // 16 bits of CRC pass about one candidate in 65,536, and none of them is borne out.
  EXPECT_EQ(decoder.statistics().frames, 0);
  EXPECT_GT(decoder.statistics().broken, 1000);
  const Bytes good = joined(frames_of(500, 10));
  EXPECT_GE(counters(decoder, good).size(), 9U);  // the noise may have swallowed the first one's beginning
}

}  // namespace
}  // namespace waverig::rig
