// Streaming reader of comma-separated numbers with a header, plain or gzip. Every complaint is a UserError
// that names file, line, column, value and what was expected.
#pragma once
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/error.h"

struct gzFile_s;

namespace waverig::evaluation {

class CsvReader {
 public:
  // Opens the file and reads the header. Throws UserError where it is missing or empty.
  explicit CsvReader(const std::filesystem::path& path);

  const std::vector<std::string>& columns() const { return columns_; }
  // Position of a column; -1 where the file has none of that name.
  int find(std::string_view column) const;
  // Throws UserError where the header has one of them twice.
  void refuse_twice(std::initializer_list<std::string_view> columns) const;

  // Next row; false at the end. Throws where the row has another number of cells than the header.
  bool next();
  std::string_view cell(int column) const { return cells_[static_cast<std::size_t>(column)]; }
  bool empty(int column) const { return cell(column).empty(); }
  std::int64_t integer(int column) const;
  double number(int column) const;         // finite
  double number_or_nan(int column) const;  // an empty cell or "nan" is NaN

  std::int64_t line() const { return line_; }
  std::string name() const { return path_.string(); }
  UserError complaint(int column, std::string_view expected) const;
  UserError header_complaint(std::string_view expected) const;

 private:
  struct Closer {
    void operator()(gzFile_s* file) const;
  };
  bool read_line(std::string_view& line);
  void split(std::string_view line);

  std::filesystem::path path_;
  std::unique_ptr<gzFile_s, Closer> file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // what of buffer_ is not consumed
  std::int64_t line_ = 0;
  std::vector<std::string> columns_;
  std::vector<std::string_view> cells_;
  std::string header_;
};

}  // namespace waverig::evaluation
