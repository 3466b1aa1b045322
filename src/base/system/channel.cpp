// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/channel.hpp"

#include <cerrno>
#include <cstring>
#include <sys/socket.h>
#include <sys/uio.h>

namespace isotet::core {
namespace {

/// A packet of one byte, with room for two descriptors.
struct Packet {
    char byte = 1;
    iovec part{&byte, 1};
    alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))] = {};
    msghdr message{};

    Packet() {
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        message.msg_control = control;
        message.msg_controllen = sizeof control;
    }
    Packet(const Packet&) = delete;
    Packet& operator=(const Packet&) = delete;
};

} // namespace

bool send_parcel(int channel, int request, int reply) {
    Packet packet;
    cmsghdr* const header = CMSG_FIRSTHDR(&packet.message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(2 * sizeof(int));
    const int files[2] = {request, reply};
    std::memcpy(CMSG_DATA(header), files, sizeof files);
    ssize_t sent = 0;
    do sent = ::sendmsg(channel, &packet.message, MSG_NOSIGNAL);
    while (sent < 0 && errno == EINTR);
    return sent == 1;
}

std::optional<Parcel> receive_parcel(int channel) {
    Packet packet;
    ssize_t received = 0;
    do received = ::recvmsg(channel, &packet.message, MSG_CMSG_CLOEXEC);
    while (received < 0 && errno == EINTR);
    const cmsghdr* const header = received == 1 ? CMSG_FIRSTHDR(&packet.message) : nullptr;
    if (!header || header->cmsg_type != SCM_RIGHTS || header->cmsg_len != CMSG_LEN(2 * sizeof(int)))
        return std::nullopt;
    int files[2];
    std::memcpy(files, CMSG_DATA(header), sizeof files);
    return Parcel{Descriptor(files[0]), Descriptor(files[1])};
}

} // namespace isotet::core
