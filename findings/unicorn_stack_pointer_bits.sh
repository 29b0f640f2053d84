#!/bin/sh
# Guess: an emulated Cortex-M4 keeps the two lowest bits of its stack pointers zero, as the architecture manual has it (ARMv7-M, B1.4.7:
# bits 1:0 of SP are read as zero and writes are ignored).
#
# Seen, with Unicorn 2.1.4 on Python 3.11: MSR to PSP and MOV to SP keep all bits. QEMU 7.2, from which Unicorn descends, answers
# with zeros.
#
# A stack that a program puts at an address that is no multiple of 4 lies below it on the chip, and at it in this emulator.
#
# Fails if a value changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check unicorn==2.1.4
"$folder/env/bin/python" - <<'PYTHON'
from unicorn import UC_ARCH_ARM, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn.arm_const import UC_ARM_REG_R1, UC_ARM_REG_R2, UC_CPU_ARM_CORTEX_M4

FLASH = 0x0800_0000
WRITTEN = 0x2000_1003
for name, code in (
    ("msr psp, r1; mrs r2, psp", "81f30988 eff30982"),
    ("mov sp, r1; mov r2, sp", "8d46 6a46"),
):
    chip = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
    chip.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M4)
    chip.mem_map(FLASH, 0x1000)
    chip.mem_write(FLASH, bytes.fromhex(code))
    chip.reg_write(UC_ARM_REG_R1, WRITTEN)
    chip.emu_start(FLASH | 1, FLASH + len(bytes.fromhex(code)))
    read = chip.reg_read(UC_ARM_REG_R2)
    print(f"{name}, r1 = {WRITTEN:#010x}: r2 = {read:#010x}")
    assert read == WRITTEN, "CHANGED"
PYTHON
