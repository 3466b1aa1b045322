// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/sandbox.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

#include "io/files/file_kind.hpp"

namespace isotet::io::confined {
namespace {

void allow_reading(int ruleset, const std::string& path) {
    const Descriptor place(::open(path.c_str(), O_PATH | O_CLOEXEC));
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
    const Descriptor ruleset(
        static_cast<int>(::syscall(SYS_landlock_create_ruleset, &handled, sizeof handled, 0))); // its first member
    if (!ruleset) return;
    for (const std::string& path : readable) allow_reading(ruleset.number(), path);
    // How much memory is free.
    for (const char* path : {"/proc/meminfo", "/proc/self/statm", "/proc/self/cgroup", "/sys/fs/cgroup"})
        allow_reading(ruleset.number(), path);
    ::syscall(SYS_landlock_restrict_self, ruleset.number(), 0);
}

#if defined(__x86_64__) || defined(__aarch64__)

#if defined(__x86_64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#endif

/// A seccomp program: each call adds what decides about one system call; the end refuses all others.
class Filter {
public:
    Filter() {
        load(offsetof(seccomp_data, arch));
        jump(BPF_JEQ, architecture, 1, 0);
        answer(SECCOMP_RET_KILL_PROCESS);
        load(offsetof(seccomp_data, nr));
    }
    void allow(long call) {
        jump(BPF_JEQ, static_cast<std::uint32_t>(call), 0, 1);
        answer(SECCOMP_RET_ALLOW);
    }
    void refuse(long call, int error) {
        jump(BPF_JEQ, static_cast<std::uint32_t>(call), 0, 1);
        answer(refusal(error));
    }
    void allow_without(long call, unsigned argument, std::uint32_t bits, int error) {
        on_argument(call, argument);
        jump(BPF_JSET, bits, 0, 1);
        answer(refusal(error));
        answer(SECCOMP_RET_ALLOW);
    }
    void allow_with(long call, unsigned argument, std::uint32_t bits, int error) {
        on_argument(call, argument);
        jump(BPF_JSET, bits, 1, 0);
        answer(refusal(error));
        answer(SECCOMP_RET_ALLOW);
    }
    void allow_equal(long call, unsigned argument, std::uint32_t value, int error) {
        on_argument(call, argument);
        jump(BPF_JEQ, value, 1, 0);
        answer(refusal(error));
        answer(SECCOMP_RET_ALLOW);
    }
    void install() {
        answer(refusal(EPERM));
        const sock_fprog program{static_cast<unsigned short>(steps_.size()), steps_.data()};
        ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program);
    }

private:
    static constexpr std::uint32_t refusal(int error) { return SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error); }

    /// Four steps follow, which end the program if it is this call.
    void on_argument(long call, unsigned argument) {
        jump(BPF_JEQ, static_cast<std::uint32_t>(call), 0, 4);
        load(static_cast<std::uint32_t>(offsetof(seccomp_data, args) + 8 * argument)); // its low half: little-endian
    }
    void load(std::uint32_t at) { steps_.push_back({BPF_LD | BPF_W | BPF_ABS, 0, 0, at}); }
    void jump(unsigned kind, std::uint32_t value, std::uint8_t when_true, std::uint8_t when_false) {
        steps_.push_back({static_cast<std::uint16_t>(BPF_JMP | kind | BPF_K), when_true, when_false, value});
    }
    void answer(std::uint32_t value) { steps_.push_back({BPF_RET | BPF_K, 0, 0, value}); }

    std::vector<sock_filter> steps_;
};

void confine_calls() {
    Filter filter;
    constexpr long allowed[] = {
        SYS_read,
        SYS_pread64,
        SYS_readv,
        SYS_preadv,
        SYS_lseek,
        SYS_close,
        SYS_fstat,
        SYS_newfstatat,
        SYS_statx,
        SYS_statfs,
        SYS_fstatfs,
        SYS_faccessat,
        SYS_readlinkat,
        SYS_getdents64,
        SYS_getcwd,
        SYS_flock,
        SYS_fadvise64,
        SYS_dup,
        SYS_write,
        SYS_writev,
        SYS_pwrite64,
        SYS_recvmsg,
        SYS_munmap,
        SYS_mremap,
        SYS_madvise,
        SYS_brk,
        SYS_futex,
        SYS_sched_yield,
        SYS_sched_getaffinity,
        SYS_nanosleep,
        SYS_clock_nanosleep,
        SYS_clock_gettime,
        SYS_clock_getres,
        SYS_gettimeofday,
        SYS_getrusage,
        SYS_times,
        SYS_sysinfo,
        SYS_uname,
        SYS_getpid,
        SYS_getppid,
        SYS_gettid,
        SYS_getuid,
        SYS_geteuid,
        SYS_getgid,
        SYS_getegid,
        SYS_getrandom,
        SYS_rt_sigaction,
        SYS_rt_sigprocmask,
        SYS_rt_sigreturn,
        SYS_sigaltstack,
        SYS_set_robust_list,
        SYS_set_tid_address,
        SYS_rseq,
        SYS_exit,
        SYS_exit_group,
        SYS_ppoll,
        SYS_restart_syscall,
        SYS_membarrier,
        SYS_getcpu,
#if defined(__x86_64__)
        SYS_stat,
        SYS_lstat,
        SYS_access,
        SYS_readlink,
        SYS_getdents,
        SYS_poll,
        SYS_time,
        SYS_getrlimit,
        SYS_setrlimit,
#endif
#ifdef SYS_faccessat2
        SYS_faccessat2,
#endif
    };
    for (const long call : allowed) filter.allow(call);
    constexpr auto to_write =
        static_cast<std::uint32_t>(O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY));
    filter.allow_without(SYS_openat, 2, to_write, EACCES);
#if defined(__x86_64__)
    filter.allow_without(SYS_open, 1, to_write, EACCES);
#endif
    filter.allow_without(SYS_mmap, 2, PROT_EXEC, EACCES);
    filter.allow_without(SYS_mprotect, 2, PROT_EXEC, EACCES);
    filter.allow_with(SYS_clone, 0, CLONE_THREAD, EPERM); // threads, but no processes
    filter.allow_equal(SYS_prlimit64, 0, 0, EPERM);
    filter.allow_equal(SYS_tgkill, 0, static_cast<std::uint32_t>(::getpid()), EPERM); // abort()
    // Of fcntl() nothing that names a process to be signalled.
    filter.allow_without(SYS_fcntl, 1, ~std::uint32_t(7 | F_DUPFD_CLOEXEC), EPERM);
    filter.refuse(SYS_ioctl, ENOTTY);
    filter.refuse(SYS_clone3, ENOSYS); // its flags cannot be seen; the C library then calls clone()
#ifdef SYS_openat2
    filter.refuse(SYS_openat2, ENOSYS);
#endif
    filter.install();
}

#else

void confine_calls() {}

#endif

} // namespace

void confine(std::span<const std::string> readable) {
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
    confine_files(readable);
    confine_calls();
}

} // namespace isotet::io::confined
