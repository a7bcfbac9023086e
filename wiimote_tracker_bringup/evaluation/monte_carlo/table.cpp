#include "table.h"

#include <iomanip>
#include <stdexcept>

namespace wiimote_tracker::monte_carlo {

Table::Table(const std::string& path, const std::vector<std::string>& columns)
    : path_(path), file_(path), columns_(columns.size()) {
  if (!file_)
    throw std::runtime_error("cannot write to " + path + "; choose another --output");
  file_ << std::setprecision(9);
  for (const std::string& name : columns)
    *this << name;
}

void Table::close() {
  if (column_ != 0)
    throw std::runtime_error("a row of " + path_ + " is not complete");
  file_.close();
  if (!file_)
    throw std::runtime_error("cannot write all of " + path_ + "; is the disk full?");
}

}  // namespace wiimote_tracker::monte_carlo
