// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/sandbox.hpp"

#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <linux/landlock.h>
#include <linux/sched.h>
#include <memory>
#include <optional>
#include <seccomp.h>
#include <sstream>
#include <string>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/system/descriptor.hpp"

namespace isotet::io::confined {
namespace {

void allow_reading(int ruleset, const std::string& path) {
    const core::Descriptor place(::open(path.c_str(), O_PATH | O_CLOEXEC));
    struct stat status{};
    if (!place || ::fstat(place.number(), &status) != 0) return;
    landlock_path_beneath_attr rule{};
    rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    if (S_ISDIR(status.st_mode)) rule.allowed_access |= LANDLOCK_ACCESS_FS_READ_DIR;
    rule.parent_fd = place.number();
    ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
}

void confine_files(std::span<const std::string> readable) {
    const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (version < 1) return;
    // Every right that the version knows: 13, and one each that versions 2, 3 and 5 added.
    const unsigned rights = version >= 5 ? 16 : version >= 3 ? 15 : version == 2 ? 14 : 13;
    const std::uint64_t handled = (std::uint64_t(1) << rights) - 1;
    const core::Descriptor ruleset(
        static_cast<int>(::syscall(SYS_landlock_create_ruleset, &handled, sizeof handled, 0))); // its first member
    if (!ruleset) return;
    for (const std::string& path : readable) allow_reading(ruleset.number(), path);
    // How much memory is free.
    for (const char* path : {"/proc/meminfo", "/proc/self/statm", "/proc/self/cgroup", "/sys/fs/cgroup"})
        allow_reading(ruleset.number(), path);
    ::syscall(SYS_landlock_restrict_self, ruleset.number(), 0);
}

/// A seccomp program: calls that are not named are refused with EPERM, another machine's calls end the process.
class Filter {
public:
    Filter() : filter_(seccomp_init(SCMP_ACT_ERRNO(EPERM)), &seccomp_release) {
        if (filter_) seccomp_attr_set(filter_.get(), SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS);
    }
    void allow(int call) { add(SCMP_ACT_ALLOW, call, {}); }
    void refuse(int call, int error) { add(SCMP_ACT_ERRNO(static_cast<std::uint32_t>(error)), call, {}); }
    /// Where of an argument's low half the bits of `mask` are `value`.
    void allow_where(int call, unsigned argument, std::uint32_t mask, std::uint32_t value) {
        add(SCMP_ACT_ALLOW, call, SCMP_CMP(argument, SCMP_CMP_MASKED_EQ, mask, value));
    }
    /// Else EACCES, from which libraries know that they may only read.
    void allow_without(int call, unsigned argument, std::uint32_t bits) {
        allow_where(call, argument, bits, 0);
        for (std::uint32_t bit = 1; bit; bit <<= 1U)
            if (bits & bit) add(SCMP_ACT_ERRNO(EACCES), call, SCMP_CMP(argument, SCMP_CMP_MASKED_EQ, bit, bit));
    }
    void install() {
        if (filter_ && complete_) seccomp_load(filter_.get());
    }

private:
    void add(std::uint32_t action, int call, std::optional<scmp_arg_cmp> condition) {
        if (!filter_ || call == __NR_SCMP_ERROR) return;
        const int result = condition ? seccomp_rule_add(filter_.get(), action, call, 1, *condition)
                                     : seccomp_rule_add(filter_.get(), action, call, 0);
        if (result != 0) complete_ = false;
    }

    std::unique_ptr<void, decltype(&seccomp_release)> filter_;
    bool complete_ = true;
};

void confine_calls() {
    Filter filter;
    // Those that an architecture or libseccomp does not have are left out.
    std::istringstream allowed(
        "read pread64 readv preadv lseek close fstat newfstatat statx statfs fstatfs faccessat readlinkat "
        "getdents64 getcwd flock fadvise64 dup write writev pwrite64 recvmsg munmap mremap madvise brk futex "
        "sched_yield sched_getaffinity nanosleep clock_nanosleep clock_gettime clock_getres gettimeofday "
        "getrusage times sysinfo uname getpid getppid gettid getuid geteuid getgid getegid getrandom "
        "rt_sigaction rt_sigprocmask rt_sigreturn sigaltstack set_robust_list set_tid_address rseq exit "
        "exit_group ppoll restart_syscall membarrier getcpu stat lstat access readlink getdents poll time "
        "getrlimit setrlimit faccessat2");
    for (std::string name; allowed >> name;) filter.allow(seccomp_syscall_resolve_name(name.c_str()));
    constexpr auto to_write =
        static_cast<std::uint32_t>(O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY));
    filter.allow_without(SCMP_SYS(openat), 2, to_write);
    filter.allow_without(SCMP_SYS(open), 1, to_write);
    filter.allow_without(SCMP_SYS(mmap), 2, PROT_EXEC);
    filter.allow_without(SCMP_SYS(mprotect), 2, PROT_EXEC);
    filter.allow_where(SCMP_SYS(clone), 0, CLONE_THREAD, CLONE_THREAD); // threads, but no processes
    constexpr std::uint32_t all_bits = ~std::uint32_t{0};
    filter.allow_where(SCMP_SYS(prlimit64), 0, all_bits, 0);
    filter.allow_where(SCMP_SYS(tgkill), 0, all_bits, static_cast<std::uint32_t>(::getpid())); // abort()
    // Of fcntl() nothing that names a process to be signalled.
    filter.allow_where(SCMP_SYS(fcntl), 1, ~std::uint32_t(7 | F_DUPFD_CLOEXEC), 0);
    filter.refuse(SCMP_SYS(ioctl), ENOTTY);
    filter.refuse(SCMP_SYS(clone3), ENOSYS); // its flags cannot be seen; the C library then calls clone()
    filter.refuse(SCMP_SYS(openat2), ENOSYS);
    filter.install();
}

} // namespace

void confine(std::span<const std::string> readable) {
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
    confine_files(readable);
    confine_calls();
}

} // namespace isotet::io::confined
