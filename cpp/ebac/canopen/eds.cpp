#include "ebac/canopen/eds.hpp"

#include <array>
#include <iomanip>
#include <sstream>
#include <string_view>
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
LSS_Supported=0
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

std::string number(Type type, std::int64_t value) {
  return is_signed(type) ? std::to_string(value) : "0x" + hex(value, 1);
}

std::string_view access(Access access) {
  constexpr std::array<std::string_view, 4> kNames{"const", "ro", "wo", "rw"};
  return kNames[static_cast<std::size_t>(access)];
}

std::string default_of(const ObjectDictionary& objects, std::size_t slot) {
  const Entry& entry = kDriveTable.entry[slot];
  if (entry.type == Type::kString) return std::string(entry.text);
  if (entry.plus_node) return "$NODEID+0x" + hex(entry.initial, 1);
  return number(entry.type, objects.initial(slot));
}

void write_value(std::ostream& out, const ObjectDictionary& objects, std::size_t slot) {
  const Entry& entry = kDriveTable.entry[slot];
  out << "DataType=0x" << hex(static_cast<std::int64_t>(entry.type), 4)
      << "\nAccessType=" << access(objects.access(slot))
      << "\nDefaultValue=" << default_of(objects, slot)
      << "\nPDOMapping=" << (entry.mapping == Mapping::kNo ? 0 : 1) << "\n";
  if (entry.type == Type::kString) return;
  if (entry.low > lowest(entry.type)) out << "LowLimit=" << number(entry.type, entry.low) << "\n";
  if (entry.high < highest(entry.type)) {
    out << "HighLimit=" << number(entry.type, entry.high) << "\n";
  }
}

/// How many entries of an object the drive has.
std::size_t shown(const ObjectDictionary& objects, const Object& object) {
  std::size_t count = 0;
  for (std::size_t slot = object.first; slot < std::size_t{object.first} + object.count; ++slot) {
    count += objects.hidden(slot) ? 0 : 1;
  }
  return count;
}

void write_object(std::ostream& out, const ObjectDictionary& objects, const Object& object) {
  const std::string section = hex(object.index, 4);
  out << "\n[" << section << "]\nParameterName=" << object.name << "\nObjectType=0x"
      << hex(static_cast<std::int64_t>(object.shape), 1) << "\n";
  if (object.shape == Shape::kVar) return write_value(out, objects, object.first);
  out << "SubNumber=" << shown(objects, object) << "\n";
  for (std::size_t slot = object.first; slot < std::size_t{object.first} + object.count; ++slot) {
    if (objects.hidden(slot)) continue;
    const Entry& entry = kDriveTable.entry[slot];
    out << "\n[" << section << "sub" << hex(entry.sub, 1) << "]\nParameterName=" << entry.name
        << "\nObjectType=0x7\n";
    write_value(out, objects, slot);
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
  std::ostringstream out;
  out << kHead;
  for (std::size_t list = 0; list < kLists.size(); ++list) {
    std::vector<const Object*> members;
    for (std::size_t i = 0; i < kDriveTable.objects; ++i) {
      const Object& object = kDriveTable.object[i];
      if (list_of(object.index) == list && shown(objects, object) > 0) members.push_back(&object);
    }
    out << "\n[" << kLists[list] << "]\nSupportedObjects=" << members.size() << "\n";
    for (std::size_t i = 0; i < members.size(); ++i) {
      out << i + 1 << "=0x" << hex(members[i]->index, 4) << "\n";
    }
    for (const Object* object : members) write_object(out, objects, *object);
  }
  return out.str();
}

}  // namespace ebac::can
