#!/usr/bin/env python3
"""Runs the programs of the probe that compare cores in QEMU, and writes what they leave in memory to files beside this one, as the
tests of the emulator compare it.

usage: from_qemu.py FOLDER    (that of `cargo xtask probe`)

QEMU's board is a Netduino Plus 2 (STM32F405: the same core, flash and RAM at the same addresses).
"""
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

RAM, RAM_SIZE = 0x20000000, 128 * 1024
GROUPS = 4
BLOCKS, HANDLERS, STACKS = 3, 2, 2
# Upper half of the words with which a step of the exceptions begins.
STEPS = (0x9000, 0xA000, 0xB000, 0xC000, 0xD000, 0xF000)


class Elf:
    """Symbols and loaded contents of a 32-bit little-endian executable."""

    def __init__(self, path):
        self.file = open(path, "rb").read()
        (self.segments_at, sections_at) = struct.unpack_from("<II", self.file, 28)
        (entry, self.segments, _, sections) = struct.unpack_from("<HHHH", self.file, 42)
        headers = [struct.unpack_from("<10I", self.file, sections_at + 40 * n) for n in range(sections)]
        self.symbols = {}
        for header in headers:
            if header[1] == 2:
                names = headers[header[6]][4]
                for at in range(header[4], header[4] + header[5], 16):
                    name, value = struct.unpack_from("<II", self.file, at)
                    self.symbols[self.text(names + name)] = value

    def text(self, at):
        return self.file[at:self.file.index(b"\0", at)].decode()

    def offset(self, address):
        for n in range(self.segments):
            _, offset, virtual, _, size = struct.unpack_from("<5I", self.file, self.segments_at + 32 * n)
            if virtual <= address < virtual + size:
                return offset + address - virtual
        raise ValueError(f"{address:#010x} is in no segment")


def ram_after(elf, path, finished, options=()):
    """The RAM once the word at symbol `finished` is not 0."""
    command = ["qemu-system-arm", "-M", "netduinoplus2", "-kernel", path, "-display", "none", "-serial", "none",
               "-monitor", "stdio", *options]
    qemu = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    with tempfile.NamedTemporaryFile() as dump:
        for _ in range(600):
            time.sleep(0.5)
            qemu.stdin.write(f'pmemsave {RAM} {RAM_SIZE} "{dump.name}"\n')
            qemu.stdin.flush()
            time.sleep(0.5)
            ram = open(dump.name, "rb").read()
            if len(ram) == RAM_SIZE and word(ram, elf.symbols[finished]) != 0:
                break
        else:
            raise SystemExit("the program does not end")
    qemu.stdin.write("quit\n")
    qemu.communicate()
    return ram


def word(ram, address):
    return struct.unpack_from("<I", ram, address - RAM)[0]


def register(position):
    names = [f"s{n}" for n in range(32)] + ["apsr", "fpscr"] + [f"r{n}" for n in range(13)] + ["lr"]
    return names[position]


def instructions(elf, path):
    ram = ram_after(elf, path, "FORMS_RUN")
    table = elf.offset(elf.symbols["FORMS"])
    for n in range(word(ram, elf.symbols["FORMS_RUN"])):
        _, name = struct.unpack_from("<II", elf.file, table + 8 * n)
        at = elf.symbols["ANSWERS"] - RAM + (4 * GROUPS + 20) * n
        sums = struct.unpack_from(f"<{GROUPS}I", ram, at)
        positions = ram[at + 4 * GROUPS:at + 4 * GROUPS + 4]
        values = struct.unpack_from("<4I", ram, at + 4 * GROUPS + 4)
        sample = [f"{register(p)}={v:08x}" for p, v in zip(positions, values) if p != 255]
        yield " | ".join([" ".join(f"{s:08x}" for s in sums), elf.text(elf.offset(name)), " ".join(sample)])


def exceptions(elf, path):
    ram = ram_after(elf, path, "FINISHED")
    log = elf.symbols["LOG"]
    words = [word(ram, log + 4 * n + 4) for n in range(word(ram, log))]
    lines = []
    for entry in words:
        if not lines or entry >> 16 in STEPS:
            lines.append([])
        lines[-1].append(f"{entry:08x}")
    return (" ".join(line) for line in lines)


def interrupted(elf, path):
    """An instruction takes 8 ns, and a cycle of SysTick 6 ns: no instruction is left out when its period grows by one."""
    ram = ram_after(elf, path, "FINISHED", ["-icount", "shift=3"])
    for n in range(BLOCKS * HANDLERS * STACKS):
        total, different, missed = struct.unpack_from("<3I", ram, elf.symbols["OUTCOMES"] - RAM + 12 * n)
        yield f"{total:08x} {different} {missed}"


folder = pathlib.Path(sys.argv[1])
for program in (instructions, exceptions, interrupted):
    path = str(folder / program.__name__)
    answers = pathlib.Path(__file__).with_name(program.__name__ + ".txt")
    answers.write_text("".join(line + "\n" for line in program(Elf(path), path)))
