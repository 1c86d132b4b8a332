// .npz: numpy's arrays as the files of a ZIP archive, stored without compression (APPNOTE.TXT of PKWARE, 4.3). Stored,
// because a table hardly gets smaller (its low digits are rounding), and because then it takes no library: a checksum
// and two kinds of record.
#include <array>
#include <ostream>

#include "bytes.hpp"
#include "formats.hpp"
#include "npy.hpp"

namespace ik_tables {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kZipVersion = 20, kStored = 0, kMidnight = 0, kFirstOf1980 = 0x0021;

// CRC-32 of ISO 3309, bits reversed.
std::uint32_t checksum(const std::string& bytes) {
  std::array<std::uint32_t, 256> step;
  for (std::uint32_t i = 0; i < 256; ++i) {
    step[i] = i;
    for (int bit = 0; bit < 8; ++bit) {
      step[i] = (step[i] & 1) != 0 ? step[i] >> 1 ^ 0xedb88320 : step[i] >> 1;
    }
  }
  std::uint32_t sum = 0xffffffff;
  for (const char c : bytes) {
    sum = sum >> 8 ^ step[(sum ^ static_cast<unsigned char>(c)) & 0xff];
  }
  return ~sum;
}

class Zip {
 public:
  explicit Zip(std::ostream& out) : out_(out) {}

  void add(const std::string& name, const std::string& content) {
    std::string common;  // what the local and the central header share
    for (const std::uint16_t field : {kZipVersion, std::uint16_t(0), kStored, kMidnight, kFirstOf1980}) {
      append(common, field);
    }
    append(common, checksum(content));
    append(common, std::uint32_t(content.size()));
    append(common, std::uint32_t(content.size()));
    append(common, std::uint16_t(name.size()));
    append(common, std::uint16_t(0));  // no extra field

    append(directory_, kCentralHeader);
    append(directory_, kZipVersion);
    directory_ += common;
    for (int i = 0; i < 5; ++i) {
      append(directory_, std::uint16_t(0));  // no comment, first disk, no attributes
    }
    append(directory_, at_);
    directory_ += name;

    std::string header;
    append(header, kLocalHeader);
    header += common + name;
    out_ << header << content;
    at_ += std::uint32_t(header.size() + content.size());
    ++files_;
  }

  void finish() {
    std::string end;
    append(end, kEnd);
    for (const std::uint16_t field : {std::uint16_t(0), std::uint16_t(0), files_, files_}) {
      append(end, field);
    }
    append(end, std::uint32_t(directory_.size()));
    append(end, at_);
    append(end, std::uint16_t(0));
    out_ << directory_ << end;
  }

 private:
  std::ostream& out_;
  std::string directory_;
  std::uint32_t at_ = 0;
  std::uint16_t files_ = 0;
};

void write(const Table& table, const std::string& /*name*/, std::ostream& out) {
  Zip zip(out);
  zip.add("extension.npy", npy(table.extension, shape(table), table.precision));
  zip.add("roll.npy", npy(table.roll, {table.roll.size()}, table.precision));
  zip.add("pitch.npy", npy(table.pitch, {table.pitch.size()}, table.precision));
  zip.add("height.npy", npy(table.height, {table.height.size()}, table.precision));
  zip.add("version.npy", npy(table.version));
  zip.add("geometry_hash.npy", npy(table.geometry_hash));
  zip.add("units.npy", npy(kUnits));
  zip.finish();
}

Table read(std::istream& in) {
  const std::string bytes = whole(in);
  Table table;
  for (Reader reader(bytes); reader.number<std::uint32_t>() == kLocalHeader;) {
    reader.take(10);
    const auto sum = reader.number<std::uint32_t>();
    reader.take(4);
    const auto size = reader.number<std::uint32_t>();
    const auto name_size = reader.number<std::uint16_t>();
    reader.take(2);
    const std::string name = reader.take(name_size), content = reader.take(size);
    if (checksum(content) != sum) {
      throw std::runtime_error(name + " in it does not match its checksum");
    }
    const Array array = parse_npy(content);
    if (name == "extension.npy") {
      table.extension = array.numbers;
      table.precision = array.precision;
    }
    if (name == "roll.npy") table.roll = array.numbers;
    if (name == "pitch.npy") table.pitch = array.numbers;
    if (name == "height.npy") table.height = array.numbers;
    if (name == "version.npy") table.version = array.characters;
    if (name == "geometry_hash.npy") table.geometry_hash = array.characters;
  }
  return table;
}

}  // namespace

const Format kNpz = {"npz", ".npz", Precision::kDouble, "numpy.load: extension, roll, pitch, height, version, ...",
                     write, read};

}  // namespace ik_tables
