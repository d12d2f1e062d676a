#pragma once

#include <cstdint>

namespace ebac::can {

/// Why an SDO transfer was refused (CiA 301, table 22).
enum class Abort : std::uint32_t {
  kNone = 0,
  kToggle = 0x05030000,        // toggle bit not alternated
  kCommand = 0x05040001,       // command unknown, or not expected now
  kBlockSize = 0x05040002,     // of a block transfer
  kSequence = 0x05040003,      // number of a segment of a block
  kChecksum = 0x05040004,      // of a block transfer
  kUnsupported = 0x06010000,   // this access is not possible
  kWriteOnly = 0x06010001,     // attempt to read
  kReadOnly = 0x06010002,      // attempt to write
  kNoObject = 0x06020000,      // no such index
  kNotMappable = 0x06040041,   // not in a PDO, or not in this direction or length
  kPdoLength = 0x06040042,     // more than 8 entries or 8 bytes
  kIncompatible = 0x06040043,  // parameters contradict each other
  kLength = 0x06070010,        // not the length of the object
  kTooLong = 0x06070012,       // more bytes than the object, or than announced
  kTooShort = 0x06070013,      // fewer bytes than announced
  kNoSub = 0x06090011,         // no such sub-index
  kValue = 0x06090030,         // a value that is not offered
  kTooHigh = 0x06090031,       // above the high limit
  kTooLow = 0x06090032,        // below the low limit
  kNotStored = 0x08000020,     // wrong signature
  kState = 0x08000022,         // not in the present state of the device
  kNoData = 0x08000024,        // nothing there yet
};

}  // namespace ebac::can
