// Preloaded into a program, makes one of its calls to the system fail, so that tests see what the program
// does then.
//
//   SPLATCUT_FAULT=CALL:NTH:HOW[:FROM_BYTES]   SPLATCUT_FAULT_HIT=FILE   LD_PRELOAD=fault_shim.so   PROGRAM
//
// CALL: write, read (of files alone, not of stdin, stdout, stderr), open, close, rename, link, mkdir, remove,
//       truncate, lock, sync, map (a file into memory), allocate (blocks of FROM_BYTES and more).
// HOW: a number of errno; "short": a write or read takes half of what was asked for. "28+": the NTH and all
// after it. FILE is made where a call was reached, so that a caller who counts up knows when to end.
//
// Calls to the system are caught in the kernel (seccomp, SIGSYS) and not by name: the C library makes its
// own. Linux on x86-64.
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

// What malloc and its kin are within the C library.
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
}

namespace {

constexpr int kMostCalls = 6;
struct Group {
  const char* name;
  bool on_files;  // the first argument is an open file
  long calls[kMostCalls];
};
constexpr Group kGroups[] = {
    {"write", true, {SYS_write, SYS_pwrite64, SYS_writev, -1}},
    {"read", true, {SYS_read, SYS_pread64, SYS_readv, -1}},
    {"open", false, {SYS_openat, SYS_open, -1}},
    {"close", true, {SYS_close, -1}},
    {"rename", false, {SYS_rename, SYS_renameat, SYS_renameat2, -1}},
    {"link", false, {SYS_link, SYS_linkat, -1}},
    {"mkdir", false, {SYS_mkdir, SYS_mkdirat, -1}},
    {"remove", false, {SYS_unlink, SYS_rmdir, SYS_unlinkat, -1}},
    {"truncate", true, {SYS_ftruncate, -1}},
    {"lock", true, {SYS_flock, -1}},
    {"sync", false, {SYS_fsync, SYS_fdatasync, -1}},
    {"map", false, {-1}},
    {"allocate", false, {-1}},
};

// Read once, before the program begins; the program's threads only count.
const Group* g_group = nullptr;
long g_nth = 0, g_error = 0;
bool g_short = false, g_all_after = false;
std::size_t g_from_bytes = 0;
const char* g_hit_file = nullptr;
std::atomic<long> g_count{0};

// Calls of our own carry this as sixth argument, which none of the groups has: the filter lets them pass.
constexpr unsigned kOurs = 0x5b1a7c07;

long to_kernel(long call, long a = 0, long b = 0, long c = 0, long d = 0, long e = 0, long f = kOurs) {
  long result = 0;
  register long r10 asm("r10") = d;
  register long r8 asm("r8") = e;
  register long r9 asm("r9") = f;
  asm volatile("syscall"
               : "=a"(result)
               : "a"(call), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8), "r"(r9)
               : "rcx", "r11", "memory");
  return result;
}

bool is_turn() {
  const long n = ++g_count;
  const bool turn = n == g_nth || (g_all_after && n > g_nth);
  if (n == g_nth && g_hit_file) {
    constexpr int kMode = 0600;
    const long file =
        to_kernel(SYS_openat, AT_FDCWD, reinterpret_cast<long>(g_hit_file), O_CREAT | O_CLOEXEC, kMode);
    if (file >= 0) to_kernel(SYS_close, file);
  }
  return turn;
}

bool is_file(long descriptor) {
  struct stat status {};
  return descriptor > STDERR_FILENO &&
         to_kernel(SYS_fstat, descriptor, reinterpret_cast<long>(&status)) == 0 && S_ISREG(status.st_mode);
}

bool group_is(const char* name) {
  return g_group && std::strcmp(g_group->name, name) == 0;
}

// The C library blocks all signals while it starts a thread and reads and opens files meanwhile: a call that
// is trapped then would end the program. So the mask is kept for it, without SIGSYS.
long keep_mask(ucontext_t* context) {
  const auto& regs = context->uc_mcontext.gregs;
  const auto* wanted = reinterpret_cast<const std::uint64_t*>(regs[REG_RSI]);
  auto* before = reinterpret_cast<std::uint64_t*>(regs[REG_RDX]);
  std::uint64_t mask = 0;
  std::memcpy(&mask, &context->uc_sigmask, sizeof mask);
  const std::uint64_t old = mask;
  if (wanted) {
    const std::uint64_t set = *wanted;
    mask = regs[REG_RDI] == SIG_BLOCK ? mask | set : regs[REG_RDI] == SIG_UNBLOCK ? mask & ~set : set;
    mask &= ~(std::uint64_t{1} << (SIGSYS - 1));
    std::memcpy(&context->uc_sigmask, &mask, sizeof mask);  // in force when the handler returns
  }
  if (before) *before = old;
  return 0;
}

void on_call(int, siginfo_t* info, void* context) {
  auto& regs = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  const long call = info->si_syscall;
  if (call == SYS_rt_sigprocmask) {
    regs[REG_RAX] = keep_mask(static_cast<ucontext_t*>(context));
    return;
  }
  long bytes = regs[REG_RDX];
  const bool turn = (!g_group->on_files || is_file(regs[REG_RDI])) && is_turn();
  if (turn && call == SYS_close) to_kernel(SYS_close, regs[REG_RDI]);  // gone all the same, as Linux does it
  if (turn && !g_short) {
    regs[REG_RAX] = -g_error;
    return;
  }
  if (turn && bytes > 1) bytes /= 2;
  regs[REG_RAX] = to_kernel(call, regs[REG_RDI], regs[REG_RSI], bytes, regs[REG_R10], regs[REG_R8]);
}

// Traps each call of the group that is not ours.
bool catch_calls() {
  constexpr int kMost = kMostCalls + 6;
  sock_filter filter[kMost];
  int calls = 0, at = 0;
  while (g_group->calls[calls] >= 0) ++calls;
  const auto jump = [&](unsigned value, int if_equal, int if_not) {
    return sock_filter{BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned char>(if_equal),
                       static_cast<unsigned char>(if_not), value};
  };
  filter[at++] = {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, args) + 5 * sizeof(std::uint64_t)};
  filter[at++] = jump(kOurs, calls + 2, 0);  // to the last but one, which allows
  filter[at++] = {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, nr)};
  filter[at++] = jump(SYS_rt_sigprocmask, calls + 1, 0);
  for (int i = 0; i < calls; ++i) filter[at++] = jump(static_cast<unsigned>(g_group->calls[i]), calls - i, 0);
  filter[at++] = {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW};
  filter[at++] = {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_TRAP};
  const sock_fprog program{static_cast<unsigned short>(at), filter};
  struct sigaction action {};
  action.sa_sigaction = on_call;
  action.sa_flags = SA_SIGINFO | SA_RESTART | SA_NODEFER;
  return ::sigaction(SIGSYS, &action, nullptr) == 0 && ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

[[noreturn]] void give_up(const char* why) {
  to_kernel(SYS_write, STDERR_FILENO, reinterpret_cast<long>(why), static_cast<long>(std::strlen(why)));
  constexpr int kNotOfTheProgram = 99;
  ::_exit(kNotOfTheProgram);
}

__attribute__((constructor)) void begin() {
  const char* fault = std::getenv("SPLATCUT_FAULT");
  g_hit_file = std::getenv("SPLATCUT_FAULT_HIT");
  if (!fault) return;
  const Group* chosen = nullptr;
  for (const Group& group : kGroups) {
    const std::size_t length = std::strlen(group.name);
    if (std::strncmp(fault, group.name, length) == 0 && fault[length] == ':') chosen = &group;
  }
  if (!chosen) give_up("fault shim: SPLATCUT_FAULT names no call\n");
  char* at = nullptr;
  constexpr int kTen = 10;
  g_nth = std::strtol(fault + std::strlen(chosen->name) + 1, &at, kTen);
  if (*at != ':') give_up("fault shim: SPLATCUT_FAULT is CALL:NTH:HOW[:FROM_BYTES]\n");
  ++at;
  g_short = std::strncmp(at, "short", 5) == 0;
  if (g_short)
    at += 5;
  else
    g_error = std::strtol(at, &at, kTen);
  if (*at == '+') g_all_after = *at++ == '+';
  if (*at == ':') g_from_bytes = std::strtoull(at + 1, nullptr, kTen);
  g_group = chosen;
  if (g_group->calls[0] >= 0 && !catch_calls()) give_up("fault shim: seccomp is not to be had here\n");
}

bool allocation_fails(std::size_t bytes) {
  return g_group && bytes >= g_from_bytes && group_is("allocate") && is_turn();
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) {
  if (!allocation_fails(bytes)) return __libc_malloc(bytes);
  errno = ENOMEM;
  return nullptr;
}

void* calloc(std::size_t count, std::size_t bytes) {
  if (!allocation_fails(count * bytes)) return __libc_calloc(count, bytes);
  errno = ENOMEM;
  return nullptr;
}

void* realloc(void* block, std::size_t bytes) {
  if (!allocation_fails(bytes)) return __libc_realloc(block, bytes);
  errno = ENOMEM;
  return nullptr;
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  if (!allocation_fails(bytes)) return __libc_memalign(alignment, bytes);
  errno = ENOMEM;
  return nullptr;
}

void* memalign(std::size_t alignment, std::size_t bytes) {
  return aligned_alloc(alignment, bytes);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
  if (allocation_fails(bytes)) return ENOMEM;
  *block = __libc_memalign(alignment, bytes);
  return *block ? 0 : ENOMEM;
}

// Of a file: "map". Without one, as the allocator of TBB does it: "allocate".
void* mmap(void* address, std::size_t bytes, int protection, int flags, int descriptor,
           off_t offset) noexcept {
  const bool anonymous = (flags & MAP_ANONYMOUS) != 0;
  if (anonymous ? allocation_fails(bytes) : group_is("map") && is_turn()) {
    errno = anonymous ? ENOMEM : static_cast<int>(g_error);
    return MAP_FAILED;
  }
  const long result = to_kernel(SYS_mmap, reinterpret_cast<long>(address), static_cast<long>(bytes),
                                protection, flags, descriptor, offset);
  constexpr long kMostErrno = 4095;
  if (result < 0 && result >= -kMostErrno) {
    errno = static_cast<int>(-result);
    return MAP_FAILED;
  }
  return reinterpret_cast<void*>(result);
}

void* mmap64(void* address, std::size_t bytes, int protection, int flags, int descriptor,
             off_t offset) noexcept {
  return mmap(address, bytes, protection, flags, descriptor, offset);
}

}  // extern "C"
