#include "ebac/canopen/eds.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace ebac::can {

namespace {

constexpr std::string_view kHead = R"([FileInfo]
FileName=ebac_simulated_drive.eds
FileVersion=1
FileRevision=0
EDSVersion=4.0
Description=Simulated CANopen servo drive for torque (CiA 402)
CreationTime=12:00AM
CreationDate=01-01-2026
CreatedBy=ebac

[DeviceInfo]
VendorName=ebac
VendorNumber=0x0
ProductName=ebac simulated drive
ProductNumber=0x65626163
RevisionNumber=0x00010000
OrderCode=none
BaudRate_10=0
BaudRate_20=0
BaudRate_50=0
BaudRate_125=1
BaudRate_250=1
BaudRate_500=1
BaudRate_800=1
BaudRate_1000=1
SimpleBootUpMaster=0
SimpleBootUpSlave=1
Granularity=8
DynamicChannelsSupported=0
GroupMessaging=0
NrOfRXPDO=4
NrOfTXPDO=4
LSS_Supported=1
CompactPDO=0

[DummyUsage]
Dummy0001=0
Dummy0002=1
Dummy0003=1
Dummy0004=1
Dummy0005=1
Dummy0006=1
Dummy0007=1

[Comments]
Lines=1
Line1=Written from the table that the drive itself is served from.
)";

std::string hex(std::int64_t value, int digits) {
  std::ostringstream text;
  text << std::uppercase << std::hex << std::setfill('0') << std::setw(digits) << value;
  return text.str();
}

std::string number(bool with_sign, std::int64_t value) {
  return with_sign ? std::to_string(value) : "0x" + hex(value, 1);
}

std::string_view access(Access access) {
  constexpr std::array<std::string_view, 4> kNames{"const", "ro", "wo", "rw"};
  return kNames[static_cast<std::size_t>(access)];
}

/// An entry that the drive serves: in a slot of the table, or in its data sheet alone.
struct Row {
  std::uint16_t index;
  std::uint8_t sub;
  std::size_t slot = kNoSlot;
  const SheetEntry* extra = nullptr;
};
using Rows = std::vector<Row>;

/// All of them, in rising order.
Rows rows_of(const ObjectDictionary& objects) {
  Rows rows;
  for (std::size_t slot = 0; slot < kDriveTable.entries; ++slot) {
    const Entry& entry = kDriveTable.entry[slot];
    if (!objects.hidden(slot)) rows.push_back({entry.index, entry.sub, slot});
  }
  for (const SheetEntry& entry : objects.extras()) {
    rows.push_back({entry.index, entry.sub, kNoSlot, &entry});
  }
  std::ranges::sort(rows, {}, [](const Row& row) { return std::pair(row.index, row.sub); });
  return rows;
}

std::string default_of(const ObjectDictionary& objects, std::size_t slot) {
  const Entry& entry = kDriveTable.entry[slot];
  if (entry.type == Type::kString) return std::string(entry.text);
  const bool of_node = entry.plus_node && objects.initial(slot) == entry.initial + objects.node();
  if (of_node) return "$NODEID+0x" + hex(entry.initial, 1);
  return number(is_signed(entry.type), objects.initial(slot));
}

void write_slot(std::ostream& out, const ObjectDictionary& objects, std::size_t slot) {
  const Entry& entry = kDriveTable.entry[slot];
  const bool with_sign = is_signed(entry.type);
  const bool mappable = entry.mapping != Mapping::kNo && objects.mappable(slot);
  out << "DataType=0x" << hex(static_cast<std::int64_t>(entry.type), 4)
      << "\nAccessType=" << access(objects.access(slot))
      << "\nDefaultValue=" << default_of(objects, slot) << "\nPDOMapping=" << mappable << "\n";
  if (entry.type == Type::kString) return;
  if (entry.low > lowest(entry.type)) out << "LowLimit=" << number(with_sign, entry.low) << "\n";
  if (entry.high < highest(entry.type)) {
    out << "HighLimit=" << number(with_sign, entry.high) << "\n";
  }
}

/// The type of so many bytes, text of none: CiA 301, 7.4.7.
int type_of(const SheetEntry& entry) {
  constexpr std::array<int, 9> kSigned{0x9, 0x2, 0x3, 0x10, 0x4, 0x12, 0x13, 0x14, 0x15};
  constexpr std::array<int, 9> kUnsigned{0x9, 0x5, 0x6, 0x16, 0x7, 0x18, 0x19, 0x1A, 0x1B};
  return (entry.low < 0 ? kSigned : kUnsigned)[entry.width];
}

void write_extra(std::ostream& out, const SheetEntry& entry) {
  const bool with_sign = entry.low < 0;
  out << "DataType=0x" << hex(type_of(entry), 4) << "\nAccessType=" << access(entry.access) << "\n";
  if (entry.width == 0) out << "DefaultValue=" << entry.text << "\n";
  if (entry.width > 0 && entry.has_initial) {
    out << "DefaultValue=" << number(with_sign, entry.initial) << "\n";
  }
  out << "PDOMapping=" << entry.mappable << "\n";
  if (entry.width == 0 || entry.width == 8) return;  // not checked
  const int bits = 8 * entry.width - (with_sign ? 1 : 0);
  const std::int64_t most = (std::int64_t{1} << bits) - 1;
  const std::int64_t least = with_sign ? -most - 1 : 0;
  if (entry.low > least) out << "LowLimit=" << number(with_sign, entry.low) << "\n";
  if (entry.high < most) out << "HighLimit=" << number(with_sign, entry.high) << "\n";
}

void write_value(std::ostream& out, const ObjectDictionary& objects, const Row& row) {
  if (row.extra != nullptr) return write_extra(out, *row.extra);
  write_slot(out, objects, row.slot);
}

std::string name_of(const Row& row) {
  if (row.extra == nullptr) return std::string(kDriveTable.entry[row.slot].name);
  return "Sub-index " + std::to_string(row.sub);
}

/// One index, of which the drive has these rows. The table names it, unless none of them is its.
void write_object(std::ostream& out, const ObjectDictionary& objects, std::span<const Row> rows) {
  const std::uint16_t index = rows.front().index;
  const bool alone = rows.size() == 1 && rows.front().sub == 0;
  std::string name = "Object 0x" + hex(index, 4);
  Shape shape = alone ? Shape::kVar : Shape::kRecord;
  if (std::ranges::any_of(rows, [](const Row& row) { return row.slot != kNoSlot; })) {
    const Object& object = kDriveTable.object[kDriveTable.find(index)];
    name = object.name;
    if (alone || object.shape != Shape::kVar) shape = object.shape;
  }
  const std::string section = hex(index, 4);
  out << "\n[" << section << "]\nParameterName=" << name << "\nObjectType=0x"
      << hex(static_cast<std::int64_t>(shape), 1) << "\n";
  if (shape == Shape::kVar) return write_value(out, objects, rows.front());
  out << "SubNumber=" << rows.size() << "\n";
  for (const Row& row : rows) {
    out << "\n[" << section << "sub" << hex(row.sub, 1) << "]\nParameterName=" << name_of(row)
        << "\nObjectType=0x7\n";
    write_value(out, objects, row);
  }
}

/// CiA 306 sorts: mandatory ones, optional ones of the standards, the manufacturer's.
std::size_t list_of(std::uint16_t index) {
  if (index == 0x1000 || index == 0x1001 || index == 0x1018) return 0;
  return index >= 0x2000 && index < 0x6000 ? 2 : 1;
}

}  // namespace

std::string eds(const ObjectDictionary& objects) {
  constexpr std::array<std::string_view, 3> kLists{"MandatoryObjects", "OptionalObjects",
                                                   "ManufacturerObjects"};
  const Rows rows = rows_of(objects);
  std::array<std::vector<std::span<const Row>>, kLists.size()> members;
  for (auto first = rows.begin(); first != rows.end();) {
    const auto other = [&](const Row& row) { return row.index != first->index; };
    const auto end = std::find_if(first, rows.end(), other);
    members[list_of(first->index)].emplace_back(first, end);
    first = end;
  }
  std::ostringstream out;
  out << kHead;
  for (std::size_t list = 0; list < kLists.size(); ++list) {
    out << "\n[" << kLists[list] << "]\nSupportedObjects=" << members[list].size() << "\n";
    int count = 0;
    for (const auto& object : members[list]) {
      out << ++count << "=0x" << hex(object.front().index, 4) << "\n";
    }
    for (const auto& object : members[list]) write_object(out, objects, object);
  }
  return out.str();
}

}  // namespace ebac::can
