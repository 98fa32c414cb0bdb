#include "ros2/dds/blob.hpp"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <memory>

namespace tessera::ros2 {
namespace {

struct BlobType : ddsi_sertype {};
struct Blob : ddsi_serdata {
  std::vector<std::byte> bytes;
  std::optional<BesideMessage> beside;
};

const Blob& blob_of(const ddsi_serdata* data) { return *static_cast<const Blob*>(data); }

Blob* new_blob(const ddsi_sertype* type, ddsi_serdata_kind kind) {
  auto blob = std::make_unique<Blob>();
  ddsi_serdata_init(blob.get(), type, kind);
  return blob.release();
}

/// Cyclone DDS does not tell of the inline QoS, so it is read from the datagram, whose first fragment has it.
/// The submessage begins: kind, flags, uint16 size, uint16, uint16 offset of the inline QoS from behind this
/// field, reader, writer, and the sequence number: int32 high, uint32 low.
std::optional<BesideMessage> beside_message(const nn_rdata& first) {
  constexpr unsigned little_endian = 1, has_inline_qos = 2;
  constexpr std::size_t offset_at = 6, sequence_at = 16, shortest = 24;
  const std::size_t begin = NN_RDATA_SUBMSG_OFF(&first), end = NN_RDATA_PAYLOAD_OFF(&first);
  if (begin == 0 || end < begin + shortest) return std::nullopt;
  const unsigned char* const submessage = NN_RMSG_PAYLOADOFF(first.rmsg, begin);
  if ((submessage[1] & little_endian) == 0 || (submessage[1] & has_inline_qos) == 0) return std::nullopt;
  std::uint16_t offset = 0;
  std::memcpy(&offset, submessage + offset_at, sizeof offset);
  const std::size_t list = offset_at + sizeof offset + offset;
  if (list > end - begin) return std::nullopt;
  const auto related =
      related_identity_in(std::as_bytes(std::span(submessage + list, submessage + (end - begin))));
  if (!related) return std::nullopt;
  std::int32_t high = 0;
  std::uint32_t low = 0;
  std::memcpy(&high, submessage + sequence_at, sizeof high);
  std::memcpy(&low, submessage + sequence_at + sizeof high, sizeof low);
  constexpr std::int64_t of_high = std::int64_t{1} << 32U;
  return BesideMessage{*related, high * of_high + low};
}

// The functions that Cyclone DDS requires of a type. There are no keys, so all samples have the same one.

bool all_keys_equal(const ddsi_serdata* /*a*/, const ddsi_serdata* /*b*/) { return true; }
std::uint32_t size_of_blob(const ddsi_serdata* data) {
  return static_cast<std::uint32_t>(blob_of(data).bytes.size());
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                             std::size_t size) {
  Blob* const blob = new_blob(type, kind);
  blob->beside = beside_message(*fragment);
  blob->bytes.resize(size);
  std::uint32_t filled = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= filled) continue;  // fragments may overlap
    const unsigned char* const payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end > filled)
      std::memcpy(blob->bytes.data() + filled, payload + (filled - fragment->min), end - filled);
    filled = fragment->maxp1;
  }
  return blob;
}

ddsi_serdata* from_parts(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* parts, std::size_t size) {
  Blob* const blob = new_blob(type, kind);
  blob->bytes.reserve(size);
  for (std::size_t part = 0; part < static_cast<std::size_t>(count); ++part) {
    const auto* const first = static_cast<const std::byte*>(parts[part].iov_base);
    const std::size_t length = std::min<std::size_t>(parts[part].iov_len, size - blob->bytes.size());
    blob->bytes.insert(blob->bytes.end(), first, first + length);
  }
  return blob;
}

ddsi_serdata* from_key(const ddsi_sertype* type, const ddsi_keyhash* /*key*/) {
  return new_blob(type, SDK_KEY);
}
/// Never used: applications write bytes (write_blob) and no samples.
ddsi_serdata* from_sample(const ddsi_sertype* /*type*/, ddsi_serdata_kind /*kind*/, const void* /*sample*/) {
  return nullptr;
}
bool to_no_sample(const ddsi_serdata* /*data*/, void* /*sample*/, void** /*place*/, void* /*end*/) {
  return false;
}
bool key_to_no_sample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*data*/, void* /*sample*/,
                      void** /*place*/, void* /*end*/) {
  return false;
}

void to_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* to) {
  const std::vector<std::byte>& bytes = blob_of(data).bytes;
  const std::size_t there = offset < bytes.size() ? std::min(size, bytes.size() - offset) : 0;
  std::memcpy(to, bytes.data() + offset, there);
  std::memset(static_cast<std::byte*>(to) + there, 0, size - there);
}
ddsi_serdata* lend_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size,
                         ddsrt_iovec_t* part) {
  // The writer pads messages to four bytes, so no bytes beyond their end are requested.
  part->iov_base = const_cast<std::byte*>(blob_of(data).bytes.data()) + offset;
  part->iov_len = size;
  return ddsi_serdata_ref(data);
}
void give_bytes_back(ddsi_serdata* data, const ddsrt_iovec_t* /*part*/) { ddsi_serdata_unref(data); }
ddsi_serdata* key_of(const ddsi_serdata* data) { return new_blob(data->type, SDK_KEY); }
void free_blob(ddsi_serdata* data) { delete static_cast<Blob*>(data); }
std::size_t print_blob(const ddsi_sertype* /*type*/, const ddsi_serdata* data, char* text, std::size_t size) {
  const int length = std::snprintf(text, size, "(%zu bytes)", blob_of(data).bytes.size());
  return length < 0 ? 0 : static_cast<std::size_t>(length);
}
void no_keyhash(const ddsi_serdata* /*data*/, ddsi_keyhash* hash, bool /*md5*/) {
  std::memset(hash, 0, sizeof *hash);
}

ddsi_serdata_ops make_data_ops() {
  ddsi_serdata_ops ops{};
  ops.eqkey = all_keys_equal;
  ops.get_size = size_of_blob;
  ops.from_ser = from_fragments;
  ops.from_ser_iov = from_parts;
  ops.from_keyhash = from_key;
  ops.from_sample = from_sample;
  ops.to_ser = to_bytes;
  ops.to_ser_ref = lend_bytes;
  ops.to_ser_unref = give_bytes_back;
  ops.to_sample = to_no_sample;
  ops.to_untyped = key_of;
  ops.untyped_to_sample = key_to_no_sample;
  ops.free = free_blob;
  ops.print = print_blob;
  ops.get_keyhash = no_keyhash;
  return ops;
}

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<BlobType*>(type);
}
void zero_no_samples(const ddsi_sertype* /*type*/, void* /*samples*/, std::size_t /*count*/) {}
void no_samples(void** places, const ddsi_sertype* /*type*/, void* /*old*/, std::size_t /*old_count*/,
                std::size_t count) {
  std::fill_n(places, count, nullptr);
}
void free_no_samples(const ddsi_sertype* /*type*/, void** /*places*/, std::size_t /*count*/,
                     dds_free_op_t /*op*/) {}
/// Types of one name are equal, as far as DDS is concerned.
bool types_equal(const ddsi_sertype* /*a*/, const ddsi_sertype* /*b*/) { return true; }
std::uint32_t hash_of_type(const ddsi_sertype* /*type*/) { return 0; }

ddsi_sertype_ops make_type_ops() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = free_type;
  ops.zero_samples = zero_no_samples;
  ops.realloc_samples = no_samples;
  ops.free_samples = free_no_samples;
  ops.equal = types_equal;
  ops.hash = hash_of_type;
  return ops;
}

const ddsi_serdata_ops blob_data_ops = make_data_ops();
const ddsi_sertype_ops blob_type_ops = make_type_ops();

}  // namespace

BlobTopic create_blob_topic(dds_entity_t participant, const char* name, const char* type_name) {
  auto type = std::make_unique<BlobType>();
  constexpr bool no_key = true;
  ddsi_sertype_init(type.get(), type_name, &blob_type_ops, &blob_data_ops, no_key);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  ddsi_sertype* registered = type.release();
  const dds_entity_t topic =
      dds_create_topic_sertype(participant, name, &registered, nullptr, nullptr, nullptr);
  if (topic < 0) ddsi_sertype_unref(registered);
  return {topic, topic < 0 ? nullptr : registered};
}

dds_return_t write_blob(dds_entity_t writer, const BlobTopic& topic, std::span<const std::byte> message) {
  Blob* const blob = new_blob(topic.type, SDK_DATA);
  blob->bytes.assign(message.begin(), message.end());
  blob->timestamp.v = dds_time();
  blob->statusinfo = 0;
  return dds_writecdr(writer, blob);
}

void take_blobs(dds_entity_t reader, std::size_t most, void (*use)(void*, const TakenBlob&), void* context) {
  constexpr std::uint32_t at_once = 16;
  for (std::size_t taken = 0; taken < most;) {
    std::array<ddsi_serdata*, at_once> samples{};
    std::array<dds_sample_info_t, at_once> infos{};
    const auto wanted = static_cast<std::uint32_t>(std::min<std::size_t>(at_once, most - taken));
    const dds_return_t count = dds_takecdr(reader, samples.data(), wanted, infos.data(), DDS_ANY_STATE);
    if (count <= 0) return;
    for (std::size_t index = 0; index < static_cast<std::size_t>(count); ++index) {
      if (infos[index].valid_data)
        use(context,
            {blob_of(samples[index]).bytes, infos[index].publication_handle, blob_of(samples[index]).beside});
      ddsi_serdata_unref(samples[index]);
    }
    taken += static_cast<std::size_t>(count);
  }
}

}  // namespace tessera::ros2
