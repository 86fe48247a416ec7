// SPDX-License-Identifier: Apache-2.0
// A device over hidapi.
//
// hidraw: three descriptors on one path. hidapi keeps a handle's last error as a string in the heap, which read and write both
// free and set: two threads on ONE handle corrupt it when a device is pulled out. So reader and writer have a handle each, and
// a third descriptor, of our own, holds the claim (device_claim.hpp) and is kept for a crash (emergency.hpp).
//
// libusb: an interface can be claimed once only, so there is ONE handle. That is safe: its hid_error is a constant, the handle
// keeps no string, reads take reports from a queue under a mutex of the handle's, and writes are libusb transfers, which any
// thread may make. So on this back end hidapi briefly locks a mutex and frees a report's memory in the servo thread. Reports
// are received by a thread of hidapi, which inherits the servo thread's priority because it is started with it; otherwise a
// busy machine would delay every report. A read's time-out uses the wall clock: if that is set back, a read of a silent device
// lasts longer by as much; the writer's own limit of 10 ms then removes the force.
#include <cstring>

#include "base/real_time.hpp"
#include "fdcg_firmware.h"
#include "transport/device_claim.hpp"
#include "transport/device_identity.hpp"
#include "transport/hid_devices.hpp"
#include "transport/hid_library.hpp"
#include "transport/transports.hpp"

namespace fdcg::dev {

namespace {

class HidTransport final : public Transport {
 public:
  HidTransport(const Profile& profile, const HidAccess& access) : profile_(profile), access_(access) {}
  ~HidTransport() override { HidTransport::close(); }

  std::string open() override;
  void close() override;
  ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) override;
  bool write(const std::uint8_t* data, int bytes) override;
  bool write_feature(const std::uint8_t* data, int bytes) override;
  int emergency_descriptor() const override { return library_->is_libusb ? -1 : claim_.descriptor(); }

 private:
  std::string open_with(HidBackend backend);
  std::string open_handles(const HidDevice& device);
  std::string check_identity() const;
  std::string send_init();
  template <class Send>
  bool with_id(const std::uint8_t* data, int bytes, const Send& send);

  const Profile profile_;
  const HidAccess access_;
  const HidLibrary* library_ = nullptr;
  hid_device* reader_ = nullptr;
  hid_device* writer_ = nullptr;  // the same on libusb
  DeviceClaim claim_;
  bool must_stay_away_ = false;  // the device was found, and must not be tried by another back end
};

std::string HidTransport::open() {
  if (access_.backend != HidBackend::kAny) return open_with(access_.backend);
  const std::string hidraw_problem = open_with(HidBackend::kHidraw);
  if (hidraw_problem.empty() || must_stay_away_) return hidraw_problem;
  const std::string libusb_problem = open_with(HidBackend::kLibusb);
  if (libusb_problem.empty()) return {};
  return "hidraw: " + hidraw_problem + "; libusb: " + libusb_problem;
}

std::string HidTransport::open_with(HidBackend backend) {
  std::string problem;
  must_stay_away_ = false;
  library_ = hid_library(backend, &problem);
  if (library_ == nullptr) return problem;
  // hidraw's list is read from the kernel's, so it can tell all that is there.
  const Match& match = profile_.match;
  const std::vector<HidDevice> devices =
      library_->is_libusb ? list_hid_devices(*library_, match.vendor, match.product) : list_hid_devices(*library_);
  const HidDevice* const device = choose_hid_device(devices, match, access_.serial, access_.path, &problem);
  if (device == nullptr) return problem;
  problem = claim_.take(device_node(*device));
  must_stay_away_ = !problem.empty();
  if (must_stay_away_) return problem;
  problem = open_handles(*device);
  if (problem.empty()) {
    problem = check_identity();
    must_stay_away_ = !problem.empty();
  }
  if (problem.empty()) problem = send_init();
  if (!problem.empty()) close();
  return problem.empty() ? problem : describe(*device) + ": " + problem;
}

std::string HidTransport::open_handles(const HidDevice& device) {
  const char* const path = device.path.c_str();
  const OwnPriority priority(library_->is_libusb ? access_.servo_priority : 0);
  reader_ = library_->open_path(path);
  writer_ = library_->is_libusb ? reader_ : library_->open_path(path);
  if (reader_ == nullptr || writer_ == nullptr) {
    const std::string permission = permission_problem(device);
    return permission.empty() ? "cannot be opened; does another program use it?" : permission;
  }
  return {};
}

std::string HidTransport::check_identity() const {
  if (!describes_itself(profile_)) return {};
  std::uint8_t report[kMaxReportBytes] = {FDCG_FW_FEATURE_ID};
  const int bytes = library_->get_feature_report(writer_, report, FDCG_FW_FEATURE_BYTES + 1);
  if (bytes < 0) return "does not answer GET_REPORT of feature report 3, which tells what it is (schemas/fdcg-hid.md)";
  return identity_problem(profile_, report, bytes);
}

std::string HidTransport::send_init() {
  for (int i = 0; i < profile_.init_count; ++i) {
    const FixedReport& report = profile_.init[i];
    const int sent = report.is_feature ? library_->send_feature_report(writer_, report.data, report.bytes)
                                       : library_->write(writer_, report.data, report.bytes);
    if (sent < 0) return "init report " + std::to_string(i + 1) + " of the profile was not taken; is it the right profile?";
  }
  return {};
}

void HidTransport::close() {
  if (writer_ != nullptr && writer_ != reader_) library_->close(writer_);
  if (reader_ != nullptr) library_->close(reader_);
  reader_ = writer_ = nullptr;
  claim_.release();
}

ReadResult HidTransport::read(std::uint8_t* data, int capacity, int timeout_ms) {
  const int bytes = library_->read_timeout(reader_, data, static_cast<std::size_t>(capacity), timeout_ms);
  if (bytes > 0) return {ReadStatus::kReport, bytes};
  return {bytes == 0 ? ReadStatus::kTimeout : ReadStatus::kLost, 0};
}

// hidapi wants a 0 where a device has no ids; the profile's bytes begin with data then.
template <class Send>
bool HidTransport::with_id(const std::uint8_t* data, int bytes, const Send& send) {
  std::uint8_t with_zero[kMaxReportBytes + 1];
  const bool has_ids = profile_.has_output ? profile_.output.id != 0 : profile_.input.id != 0;
  if (bytes <= 0 || bytes > kMaxReportBytes) return false;
  if (has_ids) return send(data, static_cast<std::size_t>(bytes)) >= 0;
  with_zero[0] = 0;
  std::memcpy(with_zero + 1, data, static_cast<std::size_t>(bytes));
  return send(with_zero, static_cast<std::size_t>(bytes) + 1) >= 0;
}

bool HidTransport::write(const std::uint8_t* data, int bytes) {
  return with_id(data, bytes,
                 [this](const std::uint8_t* report, std::size_t size) { return library_->write(writer_, report, size); });
}

bool HidTransport::write_feature(const std::uint8_t* data, int bytes) {
  return with_id(data, bytes, [this](const std::uint8_t* report, std::size_t size) {
    return library_->send_feature_report(writer_, report, size);
  });
}

}  // namespace

std::unique_ptr<Transport> make_hid_transport(const Profile& profile, const HidAccess& access) {
  return std::make_unique<HidTransport>(profile, access);
}

}  // namespace fdcg::dev
