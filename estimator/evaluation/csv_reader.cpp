#include "estimator/evaluation/csv_reader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace waverig::evaluation {
namespace {

constexpr std::size_t kBlock = 1 << 16;
constexpr std::size_t kLongestLine = 1 << 16;  // bytes; a longer one is no table of numbers

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

template <class Number>
bool parse(std::string_view text, Number& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

// What a complaint shows of a cell: short, and harmless on a terminal.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? out + "…" : out;
}

}  // namespace

void CsvReader::Closer::operator()(gzFile_s* file) const { gzclose_r(file); }

CsvReader::CsvReader(const std::filesystem::path& path) : path_(path), buffer_(kBlock) {
  std::error_code ignored;  // what may not be looked at fails to open below
  if (std::filesystem::is_directory(path, ignored))
    throw UserError(fmt::format("{}: is a folder; expected a CSV file", name()));
  file_.reset(gzopen(path.c_str(), "rb"));
  if (!file_) throw UserError(fmt::format("{}: cannot be read: {}", name(), std::strerror(errno)));
  gzbuffer(file_.get(), kBlock);
  std::string_view line;
  if (!read_line(line)) throw UserError(fmt::format("{}: the file is empty; expected a header line", name()));
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  header_ = line;
  split(header_);
  columns_.assign(cells_.begin(), cells_.end());
}

int CsvReader::find(std::string_view column) const {
  const auto at = std::find(columns_.begin(), columns_.end(), column);
  return at == columns_.end() ? -1 : static_cast<int>(at - columns_.begin());
}

void CsvReader::refuse_twice(std::initializer_list<std::string_view> columns) const {
  for (const std::string_view column : columns)
    if (std::ranges::count(columns_, column) > 1)
      throw UserError(
          fmt::format("{}, line 1: column '{}' is there twice; expected it once", name(), column));
}

bool CsvReader::next() {
  std::string_view line;
  if (!read_line(line)) return false;
  if (trimmed(line).empty()) {
    const std::int64_t blank = line_;
    while (read_line(line))
      if (!trimmed(line).empty())
        throw UserError(
            fmt::format("{}, line {}: the row is empty; expected {} cells", name(), blank, columns_.size()));
    return false;
  }
  split(line);
  if (cells_.size() != columns_.size())
    throw UserError(fmt::format("{}, line {}: {} cells in '{}'; expected {} ({})", name(), line_,
                                cells_.size(), shown(line), columns_.size(), shown(header_)));
  return true;
}

std::int64_t CsvReader::integer(int column) const {
  std::int64_t value = 0;
  if (!parse(cell(column), value)) throw complaint(column, "a whole number");
  return value;
}

double CsvReader::number(int column) const {
  double value = 0;
  if (!parse(cell(column), value) || !std::isfinite(value)) throw complaint(column, "a finite number");
  return value;
}

double CsvReader::number_or_nan(int column) const {
  if (empty(column)) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  if (!parse(cell(column), value) || std::isinf(value)) throw complaint(column, "a number or an empty cell");
  return value;
}

UserError CsvReader::complaint(int column, std::string_view expected) const {
  return UserError(fmt::format("{}, line {}, column {}: '{}'; expected {}", name(), line_,
                               columns_[static_cast<std::size_t>(column)], shown(cell(column)), expected));
}

UserError CsvReader::header_complaint(std::string_view expected) const {
  return UserError(fmt::format("{}, line 1: header '{}'; expected '{}'", name(), shown(header_), expected));
}

bool CsvReader::read_line(std::string_view& line) {
  std::size_t searched = begin_;
  for (;;) {
    const auto* newline =
        static_cast<const char*>(std::memchr(buffer_.data() + searched, '\n', end_ - searched));
    if (newline != nullptr) {
      const auto at = static_cast<std::size_t>(newline - buffer_.data());
      line = std::string_view(buffer_.data() + begin_, at - begin_);
      begin_ = at + 1;
      break;
    }
    if (end_ - begin_ > kLongestLine)
      throw UserError(fmt::format("{}, line {}: longer than {} bytes; expected a row of a CSV table", name(),
                                  line_ + 1, kLongestLine));
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    searched = end_;
    begin_ = 0;
    buffer_.resize(end_ + kBlock);
    const int got = gzread(file_.get(), buffer_.data() + end_, static_cast<unsigned>(kBlock));
    int error = Z_OK;
    const char* message = gzerror(file_.get(), &error);
    if (got < 0 || error == Z_BUF_ERROR)
      throw UserError(fmt::format("{}, after line {}: {}; expected a whole gzip or plain file", name(), line_,
                                  error == Z_BUF_ERROR ? "the compressed data end too early" : message));
    if (got == 0) {
      if (end_ == 0) return false;
      line = std::string_view(buffer_.data(), end_);
      begin_ = end_;
      break;
    }
    end_ += static_cast<std::size_t>(got);
  }
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++line_;
  return true;
}

void CsvReader::split(std::string_view line) {
  cells_.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    cells_.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace waverig::evaluation
