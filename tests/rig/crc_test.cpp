#include "rig/frontend/crc.h"

#include <gtest/gtest.h>

#include <boost/crc.hpp>
#include <vector>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::rig {
namespace {

// Of the RevEng catalogue of parametrised CRC algorithms.
const std::vector<CrcParameters> kCatalogue{
    {8, 0x07, 0x00, false, false, 0x00, 0xF4},                         // CRC-8/SMBUS
    {8, 0x31, 0x00, true, true, 0x00, 0xA1},                           // CRC-8/MAXIM-DOW
    {12, 0x80F, 0x000, false, true, 0x000, 0xDAF},                     // CRC-12/UMTS: refin and refout differ
    {16, 0x1021, 0xFFFF, false, false, 0x0000, 0x29B1},                // CRC-16/IBM-3740
    {16, 0x1021, 0x0000, true, true, 0x0000, 0x2189},                  // CRC-16/KERMIT
    {16, 0x8005, 0xFFFF, true, true, 0x0000, 0x4B37},                  // CRC-16/MODBUS
    {24, 0x864CFB, 0xB704CE, false, false, 0x000000, 0x21CF02},        // CRC-24/OPENPGP
    {32, 0x04C11DB7, 0xFFFFFFFF, true, true, 0xFFFFFFFF, 0xCBF43926},  // CRC-32/ISO-HDLC
    {32, 0x04C11DB7, 0xFFFFFFFF, false, false, 0xFFFFFFFF, 0xFC891918},  // CRC-32/BZIP2
};

TEST(Crc, PassesItsSelfTestForTheCatalogue) {
  for (const CrcParameters& p : kCatalogue) EXPECT_NO_THROW(Crc{p}) << p.width << " " << p.poly;
}

TEST(Crc, FailsItsSelfTestForAWrongCheckValue) {
  CrcParameters p = kCatalogue[3];
  p.check ^= 1;
  try {
    Crc crc(p);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("expected 0x29B1"), std::string::npos);
  }
  p.width = 40;
  EXPECT_THROW(Crc{p}, UserError);
}

TEST(Crc, AgreesWithBoostOnRandomBytes) {
  RandomStream random(1, "bytes");
  const Crc crc16(kCatalogue[3]), modbus(kCatalogue[5]), crc32(kCatalogue[7]);
  for (std::size_t size = 0; size < 200; ++size) {
    std::vector<std::uint8_t> bytes(size);
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random.bits());
    boost::crc_ccitt_false_t a;
    boost::crc_optimal<16, 0x8005, 0xFFFF, 0, true, true> b;
    boost::crc_32_type c;
    a.process_bytes(bytes.data(), size);
    b.process_bytes(bytes.data(), size);
    c.process_bytes(bytes.data(), size);
    EXPECT_EQ(crc16.of(bytes), a.checksum());
    EXPECT_EQ(modbus.of(bytes), b.checksum());
    EXPECT_EQ(crc32.of(bytes), c.checksum());
  }
}

}  // namespace
}  // namespace waverig::rig
