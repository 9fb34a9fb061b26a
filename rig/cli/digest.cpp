#include "rig/cli/digest.h"

#include <glib.h>

#include <array>
#include <fstream>
#include <memory>

namespace waverig::cli {

std::string sha256_of(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  const std::unique_ptr<GChecksum, decltype(&g_checksum_free)> checksum(g_checksum_new(G_CHECKSUM_SHA256),
                                                                        g_checksum_free);
  std::ifstream in(path, std::ios::binary);
  std::array<char, 1 << 16> block;
  while (in.read(block.data(), block.size()) || in.gcount() > 0)
    g_checksum_update(checksum.get(), reinterpret_cast<const guchar*>(block.data()), in.gcount());
  return g_checksum_get_string(checksum.get());
}

}  // namespace waverig::cli
