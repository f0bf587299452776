/* SPDX-License-Identifier: Apache-2.0 */
/* Preloaded under a test: makes libserialport take a pseudo terminal for a serial port, so that the path a real
   port takes is exercised without one. It is shown an entry in /sys/class/tty and modem lines that answer. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

static int is_pty_entry(const char *path) {
  static const char prefix[] = "/sys/class/tty/pts/";
  return strncmp(path, prefix, sizeof prefix - 1) == 0;
}

static int show_link(struct stat *status) {
  memset(status, 0, sizeof *status);
  status->st_mode = S_IFLNK | 0777;
  return 0;
}

int lstat(const char *path, struct stat *status) {
  static int (*real)(const char *, struct stat *);
  if (is_pty_entry(path)) return show_link(status);
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "lstat");
  return real(path, status);
}

int __lxstat(int version, const char *path, struct stat *status) {
  static int (*real)(int, const char *, struct stat *);
  if (is_pty_entry(path)) return show_link(status);
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "__lxstat");
  return real(version, path, status);
}

ssize_t readlink(const char *path, char *target, size_t size) {
  static ssize_t (*real)(const char *, char *, size_t);
  static const char shown[] = "../../devices/virtual/tty/tty40";
  if (is_pty_entry(path)) {
    const size_t n = size < sizeof shown - 1 ? size : sizeof shown - 1;
    memcpy(target, shown, n);
    return (ssize_t)n;
  }
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "readlink");
  return real(path, target, size);
}

int ioctl(int fd, unsigned long request, ...) {
  static int (*real)(int, unsigned long, ...);
  va_list arguments;
  va_start(arguments, request);
  void *argument = va_arg(arguments, void *);
  va_end(arguments);
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "ioctl");
  const int result = real(fd, request, argument);
  const int modem = request == TIOCMGET || request == TIOCMSET || request == TIOCMBIS || request == TIOCMBIC;
  if (result >= 0 || errno != ENOTTY || !modem || !isatty(fd)) return result;
  if (request == TIOCMGET) *(int *)argument = 0;
  errno = 0;
  return 0;
}
