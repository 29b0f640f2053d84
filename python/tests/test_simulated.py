"""The display at simulated devices: `hil-sim serve`, natively."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import Plain

from thermal_display import (
    FLUX_FIELDS,
    BridgeNotOff,
    CommandError,
    ContactLaw,
    DeviceBusy,
    DeviceRestarted,
    DeviceTripped,
    Display,
    LineBroken,
    PersonReport,
    Refused,
    Simulator,
    SimulatorMissing,
    State,
    TcpLink,
    connection,
)

Serve = Callable[..., Simulator]

COPPER_ON_FOAM = """\
material copper
object room
upload begin object 12 0.342547552
upload row 0 0.000000000 72.351825342
upload row 1 0.000298478 20.820918778
upload row 2 0.005439515 2.287006593
upload row 3 0.022087613 0.430355976
upload row 4 0.036433580 0.347370219
upload row 5 0.081145930 0.122193862
upload row 6 0.121101408 0.195289988
upload row 7 0.298115601 0.075901904
upload row 8 0.402528414 0.122978938
upload row 9 1.806573887 0.129687090
upload row 10 122.552154233 180.412806470
upload row 11 600.000000000 421.304241468
upload commit 42a75046
"""
"""What docs/objects.md shows of `hil-sim object scenes/copper-on-foam.toml`."""


def until(condition: Callable[[], object], timeout_s: float = 20.0) -> None:
    """Waits for what the device or another process does."""
    end_s = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end_s, "it does not happen"
        time.sleep(0.05)


def state_by_another_program(simulator: Simulator) -> str:
    """What a second connection is told after the first one has gone."""
    with Plain(simulator.address) as plain:
        return plain.query("state")


def script(simulator: Simulator, text: str) -> subprocess.Popen[str]:
    """A Python program of its own with an open, driven display."""
    program = (
        "import os, signal, sys, time\n"
        "from thermal_display import Display\n"
        f"display = Display.tcp('{simulator.address}')\n"
        "display.arm(wait_s=20)\n"
        "display.hold(30)\n"
        "tick = display.telemetry.wait_for(lambda sample: sample.state == 'stimulus', 10).tick\n"
        "print(tick, flush=True)\n" + text
    )
    return subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


# The bridge is off at the end


def test_an_exception_leaves_the_device_with_its_bridge_off(serve: Serve) -> None:
    simulator = serve()
    with pytest.raises(ZeroDivisionError):
        with Display.tcp(simulator.address) as display:
            display.arm(wait_s=20)
            display.hold(30)
            assert display.state().state is State.STIMULUS
            _ = 1 / 0
    answer = state_by_another_program(simulator)
    assert answer.startswith("ok state=ready fault=-"), answer
    assert "*" not in answer, "checksums are on for the next program"


@pytest.mark.parametrize("end", ["sys.exit(3)", "raise RuntimeError", "del display; time.sleep(0)", "pass"])
def test_a_display_that_is_not_closed_is_off_when_python_ends(serve: Serve, end: str) -> None:
    simulator = serve()
    with script(simulator, end) as child:
        _, errors = child.communicate(timeout=60)
    assert "was not closed" in errors
    assert state_by_another_program(simulator).startswith("ok state=ready fault=-")


def test_ctrl_c_leaves_the_device_with_its_bridge_off(serve: Serve) -> None:
    simulator = serve()
    with script(simulator, "with display:\n    time.sleep(100)\n") as child:
        assert child.stdout is not None
        child.stdout.readline()
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=60)
    assert "KeyboardInterrupt" in errors
    assert state_by_another_program(simulator).startswith("ok state=ready fault=-")


def test_ctrl_c_at_a_terminal_does_not_end_the_simulated_device_first(hil_sim: str) -> None:
    program = (
        "import time\nfrom thermal_display import Display\n"
        f"with Display.simulated({hil_sim!r}) as display:\n"
        "    print('open', flush=True)\n    time.sleep(100)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as child:
        assert child.stdout is not None
        child.stdout.readline()
        # A terminal signals all programs of the foreground.
        os.killpg(child.pid, signal.SIGINT)
        _, errors = child.communicate(timeout=60)
    assert "KeyboardInterrupt" in errors
    assert "could not confirm" not in errors


def test_a_killed_program_leaves_the_device_to_its_guard(serve: Serve) -> None:
    simulator = serve()
    with script(simulator, "time.sleep(100)") as child:
        assert child.stdout is not None
        driven_tick = int(child.stdout.readline())
        child.kill()
    with Plain(simulator.address) as plain:
        # Asking is a sign of life, too, so it comes after the 2 s of the guard; how long that takes is the device's affair.
        time.sleep(3.0)
        plain.query("checksum off*42")
        cause = plain.query("cause")
    assert cause.startswith("ok cause=host-silent tick="), cause
    tripped_tick = int(cause.split("tick=")[1].split(" ")[0])
    # Its last line may have come just before that tick, or half a second after.
    assert 1500 < tripped_tick - driven_tick < 4000


# Keep-alive


def _drive_in_silence(simulator: Simulator) -> str:
    """The state after 3 s of device time in which the program sends nothing by itself."""
    with Display.tcp(simulator.address) as display:
        display.arm(wait_s=20)
        display.hold(30)
        begin = display.telemetry.wait_for(lambda sample: sample.state is State.STIMULUS).tick
        end = display.telemetry.wait_for(
            lambda sample: sample.tick - begin > 3000 or sample.state is State.TRIPPED, 30
        )
        return end.fault or end.state.value


def test_keep_alive_prevents_host_silent(serve: Serve) -> None:
    assert _drive_in_silence(serve()) == "stimulus"


def test_without_keep_alive_the_device_trips(serve: Serve, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connection, "KEEP_ALIVE_S", 1e9)
    assert _drive_in_silence(serve()) == "host-silent"


# What a device does


def test_a_finger_lands_on_copper_and_lifts(hil_sim: str) -> None:
    with Display.simulated(hil_sim, surroundings=True) as display:
        assert display.simulator is not None
        display.material("copper")
        display.arm(wait_s=20)
        display.start()
        display.wait_state("preset")
        display.simulator.press(2.0)
        land = display.events.wait("land", timeout_s=20)
        sample = display.telemetry.wait_for(
            lambda sample: sample.state is State.CONTACT and sample.force_n > 1.9, 20
        )
        assert 0 <= sample.tick - land.tick < 5000
        assert land.host_s <= land.received_s
        display.simulator.press(0.0)
        lift = display.events.wait("lift", timeout_s=20)
        assert lift.tick > land.tick
        display.wait_state("preset")


def test_a_course_is_uploaded_and_played_and_its_events_come_in_order(hil_sim: str) -> None:
    with Display.simulated(hil_sim) as display:
        display.arm(wait_s=20)
        start_c = round(display.telemetry.wait()[-1]["display_c"], 2)
        display.upload_course([(0, start_c), (0.5, start_c - 2), (1.0, start_c - 2)])
        display.play("now", repeats=2, end="neutral")
        start = display.events.wait("start", timeout_s=20)
        end = display.events.wait("end", timeout_s=20)
        assert end.tick - start.tick == 2000
        assert display.events.take() == []
        display.wait_state("armed")
        rows = display.telemetry.take()
        played = rows[(rows["tick"] >= start.tick) & (rows["tick"] < end.tick)]
        assert set(played["state"]) == {"stimulus"}
        assert abs(played["setpoint_c"].min() - (start_c - 2)) < 0.01
        # The display has followed it, nearly.
        assert abs(played["display_c"].min() - (start_c - 2)) < 0.3
        # Rows and events are on one time axis.
        first = played[0]
        assert abs((first["host_s"] - start.host_s) - (first["tick"] - start.tick) * 1e-3) < 0.5


def test_a_pulse_repeats_and_play_repeats_it(hil_sim: str) -> None:
    with Display.simulated(hil_sim, speed="max") as display:
        display.arm(wait_s=20)
        display.pulse(33, 31, 10, 0.2, 10, repeats=2, end="neutral")
        assert [display.events.wait(timeout_s=20).kind for _ in range(2)] == ["start", "end"]
        display.play()
        assert display.events.wait("end", timeout_s=20).tick > 0


def test_an_object_of_layers_is_uploaded(hil_sim: str) -> None:
    with Display.simulated(hil_sim) as display:
        display.upload_lines(COPPER_ON_FOAM.splitlines())
        assert (display.state().material, display.state().body) == ("copper", "upload")
        display.material("copper")
        assert display.state().body == "half-space"
        display.upload_object(0.5, [(2, 40)])
        assert display.state().body == "upload"
        display.object_slab(3, "insulated")
        assert display.state().body == "slab"


def test_all_questions_are_understood(hil_sim: str) -> None:
    with Display.simulated(hil_sim) as display:
        assert display.identity == display.id()
        assert display.board().reset == "power-on"
        assert display.board().simulated
        assert display.cause() is None
        assert display.self_test().result == "none"
        display.arm(wait_s=20)
        assert display.self_test().result == "passed"
        assert display.self_test().flux is None
        assert 0 < display.raw().display < 4096
        assert display.margins().gain_margin > 1
        assert display.flux() is None
        display.set_flux_sensor(0.1192, 2048, 5, 30)
        flux = display.flux()
        assert flux is not None and flux.zero_counts == 2048
        assert display.settings()[8:] == ["set flux 0.119200 2048.000 5.000 30.000"]
        display.stream(10, ["force", *FLUX_FIELDS])
        display.telemetry.take()
        row = display.telemetry.wait(5)[-1]
        assert np.isfinite(row["force_n"]) and np.isnan(row["display_c"])
        # The board has no sensor.
        assert np.isnan(row["flux_w_m2"]) and row["known"] in ("learning", "sensor-range")
        data = "00080000000400012020202040C0000000000200"
        display.store_person("P07", data)
        assert display.persons() == ["P07"]
        display.choose_person("P07")
        assert display.person() == PersonReport(code="P07", contacts=0, data=data)
        with pytest.raises(Refused, match="needs 2 contacts"):
            display.enrol_person("P08")
        display.forget_person("P07")
        assert display.persons() == []
        display.choose_person(None)
        assert display.person() == PersonReport(code=None, contacts=0, data=None)
        person = ContactLaw(0.9, 80000, 120)
        display.set_contact_law(person)
        assert display.contact_law() == person
        display.set_contact_law(None)
        assert display.contact_law() == ContactLaw(0.95, 122500, 0)
        display.set_surface(30, 1.25, 0.11)
        assert display.surface().slope_rad == 0.11
        assert display.settings()[9:] == ["set surface 30.000 1.2500 0.11000"]
        display.set_nominal_surface()
        assert display.surface().slope_rad == 0.138
        display.remove_flux_sensor()
        assert display.flux() is None
        for finger in ("thesis", "mean"):
            display.assume_finger(finger)
            assert display.assumed_finger() == finger
        for law in ("pi", "pi-10hz", "model"):
            display.set_law(law)
            assert display.law() == law
        display.mode("semi-infinite")
        display.skin(33)
        display.trigger_out("land", "start")
        display.trigger_out()
        assert display.trigger_pulse() == 10
        display.set_trigger_pulse(25)
        assert display.trigger_pulse() == 25
        display.object_temperature(20)
        status = display.state()
        assert (status.mode, status.object_c, status.state) == ("semi-infinite", 20.0, State.ARMED)
        with pytest.raises(Refused, match="needs the bridge off: abort first"):
            display.save()
        with pytest.raises(Refused, match="temperature '50' out of range; 15 to 42 C"):
            display.hold(50)
        display.abort()
        display.calibrate_clear("room")
        settings = display.settings()
        assert len(settings) == 8
        display.set_settings(settings)
        assert display.settings() == settings


def test_settings_are_stored_and_the_program_goes_on(hil_sim: str) -> None:
    with Display.simulated(hil_sim) as display:
        display.material("foam")
        tile = "set tile 2.900000 0.058500 0.103000 0.100000 0.016000"
        display.set_settings([tile])
        display.save()
        assert display.settings()[-1] == tile
        assert display.state().material is None
        assert display.restarts == 0
        # Telemetry and events go on as before.
        display.telemetry.take()
        assert len(display.telemetry.wait(20, timeout_s=20)) >= 20
        display.forget()
        assert display.settings()[-1] != tile


def test_five_fingers_are_driven_each_for_itself(hil_sim: str) -> None:
    with Display.simulated(hil_sim, fingers=5) as display:
        assert display.fingers == 5
        fingers = [display.finger(number) for number in range(5)]
        display.material("granite")
        fingers[3].material("abs")
        assert [finger.state().material for finger in fingers] == ["granite"] * 3 + ["abs", "granite"]
        display.arm(wait_s=20)
        fingers[1].hold(30)
        assert [finger.state().state.value for finger in fingers] == ["armed", "stimulus"] + ["armed"] * 3
        fingers[4].upload_course([(0, 33), (1, 32)])
        fingers[2].stream(20, ["force"])
        fingers[2].abort()
        fingers[2].wait_state("ready")
        with pytest.raises(Refused, match="'@2 err hold needs a driven display") as refused:
            display.hold(31)
        assert refused.value.finger == 2
        display.telemetry.take()
        rows = display.telemetry.wait(200, timeout_s=20)
        assert set(rows["finger"]) == {0, 1, 2, 3, 4}
        assert np.isnan(rows[rows["finger"] == 2]["display_c"]).all()
        steps = np.diff(rows[rows["finger"] == 2]["tick"].astype(np.int64))
        assert (steps == 20).all()
        latest = display.telemetry.latest(1)
        assert latest is not None and latest.state is State.STIMULUS
        with pytest.raises(ValueError, match="finger 5 is not there; the device has 0 to 4"):
            display.finger(5)
        assert display.counts.lost == 0


def test_a_thousand_lines_a_second_come_without_loss(hil_sim: str) -> None:
    with Display.simulated(hil_sim, stream_ms=1) as display:
        rows = display.telemetry.wait(3000, timeout_s=60)
        assert (np.diff(rows["tick"].astype(np.int64)) == 1).all()
        assert (display.counts.lost, display.counts.damaged, display.counts.overwritten) == (0, 0, 0)
        times_s = display.clock.times_of(rows["tick"])
        # One tick is one millisecond of the host's clock, but for what a busy computer delays.
        assert abs((times_s[-1] - times_s[0]) / (len(rows) - 1) - 1e-3) < 0.5e-3


def test_commands_work_while_telemetry_streams_at_full_rate(hil_sim: str) -> None:
    with Display.simulated(hil_sim, stream_ms=1) as display:
        for _ in range(100):
            assert display.law() == "model"
        assert display.counts.lost == 0


# Lines that cannot be used


def test_a_second_program_at_a_tcp_port_is_refused(serve: Serve) -> None:
    simulator = serve()
    with Display.tcp(simulator.address) as first:
        with pytest.raises(DeviceBusy, match="is connected, and there is one at a time"):
            Display.tcp(simulator.address)
        assert first.state().state is State.OFF
    with Display.tcp(simulator.address):
        pass


def test_a_serial_port_is_for_one_program(hil_sim: str) -> None:
    # A pseudo-terminal, which is a serial port to this end.
    with subprocess.Popen(
        [hil_sim, "serve", "--engine", "native", "--pty"], stdout=subprocess.PIPE, text=True
    ) as child:
        try:
            assert child.stdout is not None
            port = child.stdout.readline().removeprefix("listening on ").strip()
            with Display.open(port) as display:
                display.arm(wait_s=20)
                assert len(display.telemetry.wait(50, timeout_s=20)) >= 50
                with pytest.raises(DeviceBusy, match="is open in another program"):
                    Display.open(port)
                assert display.state().state is State.ARMED
            with Display.open(port) as display:
                assert display.state().state is State.READY
        finally:
            child.terminate()


def test_a_port_that_is_not_there_is_named() -> None:
    with pytest.raises(LineBroken, match="cannot open /dev/nothing"):
        Display.open("/dev/nothing")
    with pytest.raises(LineBroken, match="cannot connect to 127.0.0.1:1"):
        Display.tcp("127.0.0.1:1")
    with pytest.raises(ValueError, match="allowed is HOST:PORT"):
        Display.tcp("127.0.0.1")


def test_a_silent_port_is_no_device() -> None:
    controller, terminal = pty.openpty()
    try:
        with pytest.raises(Exception, match="does not answer"):
            Display.open(os.ttyname(terminal), timeout_s=0.3)
    finally:
        os.close(controller)
        os.close(terminal)


def test_a_device_that_ends_is_a_broken_line(serve: Serve) -> None:
    simulator = serve()
    display = Display.tcp(simulator.address)
    display.arm(wait_s=20)
    simulator.stop()
    with pytest.raises(LineBroken):
        while True:
            display.state()
    with pytest.raises(BridgeNotOff, match="may still be driven"):
        display.close()


def test_a_tripped_device_says_why(hil_sim: str, tmp_path: Path) -> None:
    scene = tmp_path / "stop.toml"
    scene.write_text(
        "duration_s = 1\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = 'copper'\n"
        "[[fault]]\nkind = 'emergency-stop'\nt_s = 0\n"
    )
    with Display.simulated(hil_sim, scene, speed="max") as display:
        display.wait_state("tripped", timeout_s=30)
        with pytest.raises(DeviceTripped, match="emergency-stop") as error:
            display.arm()
        assert error.value.fault == "emergency-stop"
        assert error.value.cause is not None and error.value.cause.fault == "emergency-stop"


@pytest.mark.parametrize("kind", ["power-cycle", "brown-out", "reset-pin"])
def test_a_wait_for_an_event_ends_when_the_device_restarts(hil_sim: str, tmp_path: Path, kind: str) -> None:
    scene = tmp_path / "restart.toml"
    scene.write_text(
        "duration_s = 30\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = 'copper'\n"
        f"[[fault]]\nkind = '{kind}'\nt_s = 1\n"
    )
    with Display.simulated(hil_sim, scene) as display:
        display.arm(wait_s=5)
        display.hold(30)
        # Without the question to a silent device this ends with EventTimeout, after a minute.
        with pytest.raises((DeviceRestarted, LineBroken)):
            display.events.wait("end", timeout_s=60)
        assert display.state().state == "off"


def test_a_missing_simulator_is_named_with_what_helps(
    monkeypatch: pytest.MonkeyPatch, hil_sim: str, tmp_path: Path
) -> None:
    with pytest.raises(SimulatorMissing, match="'nowhere/hil-sim' .*cargo build --release -p hil-sim"):
        Display.simulated("nowhere/hil-sim")
    monkeypatch.setenv("THERMAL_DISPLAY_HIL_SIM", "elsewhere")
    with pytest.raises(SimulatorMissing, match=r"'elsewhere' \(THERMAL_DISPLAY_HIL_SIM\)"):
        Display.simulated()
    with pytest.raises(FileNotFoundError, match="nowhere.toml"):
        Display.simulated(hil_sim, "nowhere.toml")
    wrong = tmp_path / "wrong.toml"
    wrong.write_text("duration_s = 'long'\n")
    with pytest.raises(SimulatorMissing, match="did not start: .*wrong.toml"):
        Display.simulated(hil_sim, wrong)


def test_a_simulated_device_ends_with_the_program_that_is_killed(hil_sim: str) -> None:
    program = (
        "import time\nfrom thermal_display import Display\n"
        f"display = Display.simulated({hil_sim!r})\n"
        "print(display.simulator.address, flush=True)\ntime.sleep(100)\n"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        address = child.stdout.readline().strip()
        child.kill()

    def gone() -> bool:
        try:
            Plain(address).__exit__(None, None, None)
        except OSError:
            return True
        return False

    until(gone)


class NoisyLink(TcpLink):
    """A line that loses and damages bytes of both directions, drawn from a seed."""

    def __init__(self, address: str, share: float, seed: int) -> None:
        super().__init__(address)
        self._share = share
        self._random = np.random.default_rng(seed)
        self.quiet = False

    def _disturbed(self, data: bytes) -> bytes:
        if self.quiet or not data:
            return data
        bits = np.frombuffer(data, np.uint8).copy()
        hit = self._random.random(len(bits)) < self._share
        bits[hit] ^= np.left_shift(1, self._random.integers(0, 8, len(bits)))[hit].astype(np.uint8)
        lost = self._random.random(len(bits)) < self._share
        return bits[~lost].tobytes()

    def send(self, data: bytes) -> None:
        super().send(self._disturbed(data))

    def receive(self) -> bytes:
        return self._disturbed(super().receive())


def test_a_noisy_line_loses_commands_and_gives_no_wrong_answers(serve: Serve) -> None:
    simulator = serve()
    link = NoisyLink(simulator.address, 1e-3, seed=3)
    link.quiet = True
    display = Display(link, stream_ms=20, timeout_s=0.3)
    link.quiet = False
    laws = ("pi", "pi-10hz", "model")
    display.arm()
    set_last: str | None = None
    failed = 0
    for n in range(300):
        law = laws[n % 3]
        try:
            display.set_law(law)  # type: ignore[arg-type]
            set_last = law
        except CommandError:
            # Whether it was executed is not known until it is asked.
            failed += 1
            set_last = None
        try:
            answered = display.law()
        except CommandError:
            failed += 1
            continue
        assert answered == (set_last or answered) and answered in laws
    assert 0 < failed < 150
    assert display.restarts == 0
    assert display.counts.damaged > 0
    display.close()
    assert state_by_another_program(simulator).startswith("ok state=ready fault=-")
