// What stands on a disk whole, and what a disk or a place does not take.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace waverig {

// True where no other name would help: the disk is full or broken, the machine out of something. All else is
// the fault of the place that was named.
bool is_of_the_machine(const std::error_code& why);

// Of a place that cannot be written, which the sentence names: throws UserError, where the machine is to
// blame std::runtime_error.
[[noreturn]] void refuse_place(const std::error_code& why, const std::string& sentence);

// All that a file holds. Throws UserError, which names it and what was expected, where it cannot be read.
std::string content_of(const std::filesystem::path& path, std::string_view expected);

// Where a path leads: to what its links name, without a slash at its end. /proc's are left as they are: they
// lead to what is open, not to a place.
std::filesystem::path led_to(std::filesystem::path path);

// Gives a finished file or folder its own name, so that it is whole under it after a loss of power too: what
// it holds is on the disk before it has the name, and the name before this returns. The files of a folder are
// to be on the disk already. Throws std::filesystem::filesystem_error.
void rename_whole(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace waverig
