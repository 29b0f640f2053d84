"""The display at a line that fails in every way, with a fake device at its end."""

from __future__ import annotations

import gc
import itertools
import logging
import os
import threading
import time
from collections.abc import Callable

import numpy as np
import pytest
from conftest import TIMEOUT_S
from fake_device import FakeDevice

from thermal_display import (
    BridgeNotOff,
    Closed,
    ContactLaw,
    DeviceBusy,
    DeviceRestarted,
    DeviceTripped,
    Display,
    Event,
    EventTimeout,
    Interrupted,
    LineBroken,
    LineDamaged,
    NoAnswer,
    NotSendable,
    NotUnderstood,
    Refused,
    State,
    StateTimeout,
    TelemetryTimeout,
    Trip,
)

T = "T {} {} 30.0 30.0 24.0 33.0 24.0 0.0 0.1 0.1 5 {}"


def until(condition: Callable[[], object]) -> None:
    """Waits for what another thread does."""
    end_s = time.monotonic() + 10.0
    while not condition():
        assert time.monotonic() < end_s, "it does not happen"
        time.sleep(0.005)


def test_opening_switches_checksums_telemetry_and_events_on(fake: FakeDevice) -> None:
    fake.raw(b"ok an answer to an earlier program\nT 5 nonsense\nok\n")
    with Display(fake, stream_ms=20) as display:
        assert fake.checksums
        assert fake.lines("stream", "events") == ["stream 20", "events on"]
        assert display.guarded
        assert display.counts.damaged == 0
        assert display.state().state is State.OFF
    assert fake.received[-4:] == ["abort", "state", "stream 0", "checksum off"]
    assert fake.closed


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda d: d.material("stainless-steel"), "material stainless-steel"),
        (lambda d: d.material_custom(401, 8960, 385, 1.5, 0.15), "material custom 401 8960 385 1.5 0.15"),
        (lambda d: d.object_temperature(None), "object room"),
        (lambda d: d.object_temperature(-5), "object -5"),
        (lambda d: d.object_half_space(), "object half-space"),
        (lambda d: d.object_slab(3, "insulated"), "object slab 3mm insulated"),
        (lambda d: d.object_slab(0.5, film_w_m2k=10), "object slab 0.5mm film 10"),
        (lambda d: d.assume_finger("mean-on-pad"), "finger mean-on-pad"),
        (lambda d: d.skin(None), "skin sensor"),
        (lambda d: d.skin(33.2), "skin 33.2"),
        (lambda d: d.mode("semi-infinite"), "mode semi-infinite"),
        (lambda d: d.set_law("pi-10hz"), "law pi-10hz"),
        (lambda d: d.arm(), "arm"),
        (lambda d: d.start(), "start"),
        (lambda d: d.clear(), "clear"),
        (lambda d: d.hold(30), "hold 30"),
        (lambda d: d.hold(np.float64(30.25), 0.5), "hold 30.25 0.5"),
        (lambda d: d.play(), "play now 1 hold"),
        (lambda d: d.play("landing", 3, "neutral"), "play landing 3 neutral"),
        (lambda d: d.pulse(33, 25, 5, 2, 3, "trigger"), "pulse 33 25 5 2 3 trigger 1 hold"),
        (lambda d: d.trigger_out("land", "end"), "trigger-out land,end"),
        (lambda d: d.trigger_out(), "trigger-out none"),
        (lambda d: d.events_on(False), "events off"),
        (lambda d: d.tune(), "tune"),
        (lambda d: d.calibrate_clear("check"), "calibrate check clear"),
        (lambda d: d.set_flux_sensor(0.1192, 2048, 5, 30), "flux set 0.1192 2048 5 30"),
        (lambda d: d.remove_flux_sensor(), "flux none"),
        (lambda d: d.take_flux_zero(), "flux zero"),
        (lambda d: d.set_contact_law(ContactLaw(0.875, 61250, 1000)), "contact 0.875 61250 1000"),
        (lambda d: d.set_contact_law(None), "contact nominal"),
        (lambda d: d.set_surface(30, 1.25, 0.11), "surface set 30 1.25 0.11"),
        (lambda d: d.set_nominal_surface(), "surface nominal"),
        (lambda d: d.choose_person("P07"), "person P07"),
        (lambda d: d.choose_person(None), "person none"),
        (lambda d: d.store_person("P07", "00" * 20), "person P07 " + "00" * 20),
        (lambda d: d.forget_person("P07"), "forget person P07"),
        (lambda d: d.set_settings(["set tile 1 2 3 4 5"]), "set tile 1 2 3 4 5"),
    ],
)
def test_commands_are_the_lines_of_the_protocol(
    fake: FakeDevice, display: Display, call: Callable[[Display], None], line: str
) -> None:
    call(display)
    assert fake.received == [line]


def test_wrong_arguments_are_refused_before_anything_is_sent(fake: FakeDevice, display: Display) -> None:
    wrong: list[Callable[[], object]] = [
        lambda: display.hold(float("nan")),
        lambda: display.object_slab(3),
        lambda: display.object_slab(3, "held", film_w_m2k=3),
        lambda: display.stream(1, ["force", "weight"]),  # type: ignore[list-item]
        lambda: display.stream(0.5),  # type: ignore[arg-type]
        lambda: display.upload_course([1, 2, 3]),
        lambda: display.set_settings(["save"]),
        lambda: display.finger(0),
        lambda: display.events.wait("touch"),
    ]
    for call in wrong:
        with pytest.raises(ValueError):
            call()
    for line in ["", "hold 3\n", "ö", "x" * 94]:
        with pytest.raises(NotSendable):
            display.query(line)
    assert fake.received == []


def test_settings_are_read_line_by_line(display: Display) -> None:
    assert display.settings() == [f"set tile {n}" for n in range(1, 9)]


def test_a_refusal_names_line_and_answer(fake: FakeDevice, display: Display) -> None:
    fake.answers["hold 99"] = "err temperature 99 out of range; temperature is 15 to 42 C"
    with pytest.raises(Refused, match="'hold 99' with 'err temperature 99 out of range") as refused:
        display.hold(99)
    assert refused.value.line == "hold 99"
    assert refused.value.reason == "temperature 99 out of range; temperature is 15 to 42 C"


def test_control_characters_of_a_device_are_shown_by_their_numbers(fake: FakeDevice, display: Display) -> None:
    fake.answers["hold 99"] = "err \x1b]0;title\x07 \x7f2J"
    with pytest.raises(Refused) as refused:
        display.hold(99)
    assert refused.value.reason == r"\u{1b}]0;title\u{7} \u{7f}2J"
    assert str(refused.value).isprintable()


@pytest.mark.parametrize("failure", ["line-lost", "line-damaged", "answer-lost", "answer-damaged", "checksum-lost"])
def test_questions_are_repeated_whatever_happens_to_line_or_answer(
    fake: FakeDevice, display: Display, failure: str
) -> None:
    fake.failures["state"] = [failure]
    assert display.state().state is State.OFF
    assert display.restarts == 0


@pytest.mark.parametrize("failure", ["line-lost", "line-damaged", "answer-lost", "answer-damaged"])
def test_rows_of_an_upload_are_repeated_and_the_rest_is_not(
    fake: FakeDevice, display: Display, failure: str
) -> None:
    fake.failures["upload row 1 2 25"] = [failure]
    display.upload_course([(0, 33), (2, 25)])
    assert fake.lines("upload").count("upload begin course 2 absolute") == 1
    assert fake.received[-1].startswith("upload commit ")


@pytest.mark.parametrize(
    ("line", "failure"),
    [
        *itertools.product(
            ["hold 30", "start"], ["line-lost", "answer-lost", "answer-damaged", "checksum-lost"]
        ),
        # The answer to save has no checksum anyway.
        *itertools.product(["save"], ["line-lost", "answer-lost", "answer-damaged"]),
    ],
)
def test_what_may_have_been_executed_is_not_repeated(
    fake: FakeDevice, display: Display, line: str, failure: str
) -> None:
    fake.failures[line] = [failure]
    command = line.split(" ")[0]
    # After a lost answer to save the device has restarted.
    with pytest.raises((NoAnswer, NotUnderstood, DeviceRestarted)) as error:
        display.query(line) if command == "save" else display._tell(line)
    assert error.value.line == line
    assert fake.lines(command) == ([] if failure == "line-lost" else [line])
    assert display.state().state in (State.OFF, State.STIMULUS)


@pytest.mark.parametrize("fingers", [0, -1, 6, 4_000_000_000])
def test_a_number_of_fingers_that_no_device_has_is_not_understood(fake: FakeDevice, fingers: int) -> None:
    fake.fingers = fingers
    with pytest.raises(NotUnderstood):
        Display(fake)


def test_the_number_of_fingers_is_asked_again_once_checksums_protect_it(fake: FakeDevice) -> None:
    # One damaged digit of the unprotected answer.
    fake.answers_without_checksums["id"] = (
        "ok thermal-display 0.2.0 fingers=3 tick_hz=1000 scan_hz=16000 protocol=1 capabilities=upload,checksum,course"
    )
    with Display(fake) as display:
        assert display.identity.fingers == 1


def test_a_damaged_line_was_not_executed_and_says_so(fake: FakeDevice, display: Display) -> None:
    fake.failures["hold 30"] = ["line-damaged"]
    with pytest.raises(LineDamaged):
        display.hold(30)
    assert fake.lines("hold") == []


def test_an_upload_whose_beginning_is_damaged_begins_again(fake: FakeDevice, display: Display) -> None:
    fake.failures["upload begin course 2 relative"] = ["line-damaged"]
    display.upload_course([(0, 0), (2, -5)], relative=True)
    assert [line.split(" ")[1] for line in fake.lines("upload")] == ["begin", "row", "row", "commit"]


@pytest.mark.parametrize("checksums", [True, False])
def test_a_late_answer_is_not_taken_for_that_of_the_next_line(fake: FakeDevice, checksums: bool) -> None:
    with Display(fake, checksums=checksums, timeout_s=TIMEOUT_S) as display:
        fake.failures["law pi"] = ["late"]
        with pytest.raises(NoAnswer):
            display.set_law("pi")
        fake.answers["law"] = "ok law=pi"
        assert display.law() == "pi"


def test_two_answers_to_a_divided_line_do_not_shift_the_answers(fake: FakeDevice, display: Display) -> None:
    fake.answers["law"] = "ok law=pi"
    for _ in range(3):
        fake.say("err checksum missing, the line has 01; send the line again with it")
        time.sleep(0.05)
        assert display.law() == "pi"


def test_garbage_is_counted_and_does_no_harm(fake: FakeDevice, display: Display) -> None:
    fake.raw(b"\xff\xfe\x00garbage\nT 1 off\nok*99\n@\n*\n" + b"\x80" * 3000 + b"\n")
    assert display.state().state is State.OFF
    until(lambda: display.counts.damaged >= 5)


def test_a_restart_between_commands_is_noticed_and_repaired(fake: FakeDevice, display: Display) -> None:
    fake.restart()
    with pytest.raises(DeviceRestarted) as error:
        display.start()
    assert error.value.line == "start"
    assert display.restarts == 1
    assert fake.checksums
    assert fake.lines("stream", "events") == ["stream 10", "events on"]
    display.start()


def test_a_restart_during_a_command_is_noticed(fake: FakeDevice, display: Display) -> None:
    fake.failures["hold 30"] = ["restart"]
    with pytest.raises(DeviceRestarted):
        display.hold(30)
    assert fake.checksums and display.guarded


def test_checksums_that_another_program_has_switched_off_are_no_restart(fake: FakeDevice, display: Display) -> None:
    fake.state = "armed"
    fake.checksums = False
    with pytest.raises(DeviceBusy, match="it is stimulus, with its bridge on"):
        display.hold(30)


def test_a_device_that_has_restarted_and_is_armed_by_the_next_line_is_switched_off(
    fake: FakeDevice, display: Display
) -> None:
    fake.restart()
    with pytest.raises(DeviceRestarted):
        display.arm()
    assert fake.state == "ready"


@pytest.mark.parametrize("checksums", [True, False])
def test_whoever_waits_is_told_that_the_device_has_restarted(fake: FakeDevice, checksums: bool) -> None:
    with Display(fake, checksums=checksums, timeout_s=TIMEOUT_S) as display:
        fake.say(T.format(10, "off", "-"))
        display.telemetry.wait(1, timeout_s=5)
        fake.restart()
        with pytest.raises(DeviceRestarted):
            display.events.wait("end", timeout_s=60)
        assert display.restarts == 1
        # The stream that was switched on again does not come either: the device is asked again, and answers.
        with pytest.raises(EventTimeout) if checksums else pytest.raises(DeviceRestarted):
            display.events.wait("end", timeout_s=1)


def test_whoever_waits_is_told_that_the_device_answers_no_more(fake: FakeDevice, display: Display) -> None:
    fake.failures["state"] = ["line-lost"] * 10
    with pytest.raises(LineBroken, match="no telemetry for"):
        display.telemetry.wait(1, timeout_s=60)
    fake.failures.clear()


def test_save_restarts_the_device_and_what_was_on_is_on_again(fake: FakeDevice, display: Display) -> None:
    display.stream(5, ["force"])
    fake.received.clear()
    display.save()
    assert fake.received == ["save", "checksum on", "stream 5 force", "events on"]
    assert display.restarts == 0
    assert display.state().state is State.OFF


def test_a_new_choice_of_fields_is_made_without_telemetry_in_between(fake: FakeDevice, display: Display) -> None:
    display.stream(5, ["force", "display"])
    assert fake.received == ["stream 0", "stream 5 display force"]
    fake.say("T 100 off 30.0 1.5 -")
    row = display.telemetry.wait(1, timeout_s=5)[-1]
    assert (row["display_c"], row["force_n"]) == (30.0, 1.5)
    assert np.isnan(row["skin_c"])


def test_threads_get_their_own_answers(display: Display) -> None:
    wrong: list[str] = []

    def ask(thread: int) -> None:
        for n in range(50):
            number = 100 * thread + n
            answer = display.query(f"settings {number}")
            if answer != f"ok set tile {number}":
                wrong.append(answer)

    threads = [threading.Thread(target=ask, args=(thread,)) for thread in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_abort_does_not_wait_for_the_line_of_another_thread(fake: FakeDevice) -> None:
    # Far beyond what the test waits: the answer to `hold` never comes.
    display = Display(fake, timeout_s=60.0)
    fake.failures["hold 30"] = ["silent"]
    ended: list[BaseException] = []

    def hold() -> None:
        try:
            display.hold(30)
        except BaseException as error:
            ended.append(error)

    thread = threading.Thread(target=hold)
    thread.start()
    assert fake.held.wait(10)
    display.abort()
    thread.join(10)
    assert isinstance(ended[0], Interrupted)
    assert fake.state == "ready"
    display.close()


def test_an_interval_with_a_fraction_is_what_the_device_makes_of_it(fake: FakeDevice, display: Display) -> None:
    display.query("stream 1.5")
    for tick in (10, 12, 16):
        fake.say(T.format(tick, "off", "-"))
    assert list(display.telemetry.wait(3, timeout_s=5)["lost_before"]) == [0, 0, 1]


def test_a_thread_that_reads_no_more_does_not_keep_abort_from_the_device(fake: FakeDevice) -> None:
    display = Display(fake)
    display.hold(30)

    def fails(event: object) -> None:
        raise RuntimeError("a defect")

    display._connection.events.put = fails  # type: ignore[method-assign]
    fake.say("E 5 0 land")
    with pytest.raises(LineBroken, match="a defect"):
        until(lambda: display.check())
    with pytest.raises(BridgeNotOff):
        display.close()
    assert fake.state == "ready"


def test_silence_of_this_end_is_broken_by_blank_lines(fake: FakeDevice, display: Display) -> None:
    until(lambda: fake.received.count("") >= 2)


# The end


def test_an_exception_ends_with_the_bridge_off_and_goes_on(fake: FakeDevice) -> None:
    with pytest.raises(ZeroDivisionError):
        with Display(fake) as display:
            display.hold(30)
            assert fake.state == "stimulus"
            _ = 1 / 0
    assert fake.state == "ready"
    assert fake.closed


def test_an_interrupt_while_a_command_waits_ends_with_the_bridge_off(fake: FakeDevice) -> None:
    fake.failures["start"] = ["interrupt"]
    with pytest.raises(KeyboardInterrupt):
        with Display(fake) as display:
            display.hold(30)
            display.start()
    assert fake.state == "ready"


def test_an_interrupt_during_close_does_not_stop_it(fake: FakeDevice) -> None:
    display = Display(fake)
    display.hold(30)
    fake.failures["abort"] = ["interrupt", "line-lost", "interrupt"]
    with pytest.raises(KeyboardInterrupt):
        display.close()
    assert fake.state == "ready"
    assert fake.closed


@pytest.mark.parametrize("failure", ["line-lost", "line-damaged", "answer-lost", "answer-damaged", "restart"])
def test_a_failing_line_is_used_until_the_bridge_is_off(fake: FakeDevice, failure: str) -> None:
    display = Display(fake, timeout_s=TIMEOUT_S)
    display.hold(30)
    fake.failures["abort"] = [failure, failure]
    display.close()
    assert fake.state == "ready"


def test_a_bridge_that_stays_driven_is_reported(fake: FakeDevice, caplog: pytest.LogCaptureFixture) -> None:
    display = Display(fake)
    fake.answers["state"] = (
        "ok state=stimulus fault=- material=- object_c=room mode=contact setpoint_c=30.00 body=half-space"
    )
    with pytest.raises(BridgeNotOff, match="after 'abort' the device answers 'ok state=stimulus"):
        display.close()
    assert fake.closed
    assert any(record.levelno == logging.CRITICAL for record in caplog.records)


def test_an_unplugged_cable_ends_every_wait_and_close_says_that_the_bridge_may_be_driven(
    fake: FakeDevice,
) -> None:
    display = Display(fake)
    threading.Timer(0.2, lambda: setattr(fake, "unplugged", True)).start()
    with pytest.raises(LineBroken, match="unplugged"):
        display.events.wait("land", timeout_s=60)
    for call in (display.state, display.check, display.telemetry.wait, display.abort):
        with pytest.raises(LineBroken):
            call()
    with pytest.raises(BridgeNotOff, match="may still be driven; the device trips by host-silent"):
        display.close()
    assert fake.closed


def test_without_telemetry_the_device_has_no_guard_and_the_error_says_so(fake: FakeDevice) -> None:
    display = Display(fake)
    display.stream(0)
    assert not display.guarded
    fake.unplugged = True
    with pytest.raises(BridgeNotOff, match="will NOT switch off by itself"):
        display.close()


def test_an_error_beside_a_broken_line_stays_visible(fake: FakeDevice) -> None:
    with pytest.raises(BridgeNotOff) as error:
        with Display(fake):
            fake.unplugged = True
            raise RuntimeError("of the experiment")
    assert isinstance(error.value.__context__, RuntimeError)
    assert not error.value.__suppress_context__


def test_an_interrupt_beside_a_broken_line_stays_an_interrupt(
    fake: FakeDevice, caplog: pytest.LogCaptureFixture
) -> None:
    with pytest.raises(KeyboardInterrupt):
        with Display(fake):
            fake.unplugged = True
            raise KeyboardInterrupt
    assert "could not confirm that the bridge is off" in caplog.text


def test_a_forgotten_display_switches_its_bridge_off(fake: FakeDevice) -> None:
    display = Display(fake)
    display.hold(30)
    del display
    gc.collect()
    assert fake.state == "ready"
    assert fake.closed


def test_a_display_that_is_collected_in_the_thread_that_reads_switches_its_bridge_off(fake: FakeDevice) -> None:
    display = Display(fake)
    display.hold(30)
    # What an event does in that thread collects the display.
    display._connection.events.put = lambda event: display._finalizer()  # type: ignore[method-assign]
    fake.say("E 5 0 land")
    until(lambda: fake.closed)
    assert fake.state == "ready"


def test_a_finger_keeps_its_display(fake: FakeDevice) -> None:
    fake.fingers = 5
    finger = Display(fake).finger(2)
    gc.collect()
    assert not fake.closed
    assert finger.state().state is State.OFF
    assert fake.received[-1] == "@2 state"


def test_after_close_nothing_is_sent(fake: FakeDevice, display: Display) -> None:
    display.close()
    display.close()
    count = len(fake.received)
    for call in (display.start, display.state, display.abort, display.check, display.telemetry.wait):
        with pytest.raises(Closed):
            call()
    assert len(fake.received) == count


def test_a_forked_child_does_not_switch_the_parents_bridge_off(
    fake: FakeDevice, display: Display, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(os, "getpid", lambda: -1)
        display._connection.close()
    assert fake.received == [] and not fake.closed


def test_a_device_that_does_not_answer_is_left_at_once(fake: FakeDevice) -> None:
    for line in ("checksum off", "synchronize"):
        fake.answers[line] = ""
    fake.unplugged = True
    with pytest.raises(LineBroken):
        Display(fake, timeout_s=TIMEOUT_S)
    assert fake.closed


def test_a_busy_port_is_named(fake: FakeDevice) -> None:
    fake.raw(b"err busy: the client 127.0.0.1:5 is connected, and there is one at a time\n")
    threading.Timer(0.05, lambda: setattr(fake, "unplugged", True)).start()
    fake.failures["checksum off"] = ["line-lost"]

    class Mute(FakeDevice):
        def _take(self, line: str) -> None:
            return

    fake.__class__ = Mute
    with pytest.raises(DeviceBusy, match="the client 127.0.0.1:5 is connected"):
        Display(fake, timeout_s=5)


# Telemetry and events


def test_lost_lines_are_counted(fake: FakeDevice, display: Display) -> None:
    for tick in (10, 20, 50, 60):
        fake.say(T.format(tick, "off", "-"))
    rows = display.telemetry.wait(4, timeout_s=5)
    assert list(rows["tick"]) == [10, 20, 50, 60]
    assert list(rows["lost_before"]) == [0, 0, 2, 0]
    assert display.counts.lost == 2
    assert (rows["host_s"] <= rows["received_s"]).all()


def test_a_damaged_line_of_telemetry_is_lost_and_not_wrong(fake: FakeDevice, display: Display) -> None:
    fake.say(T.format(10, "off", "-"))
    fake.raw(b"T 20 off 39.0 30.0 24.0 33.0 24.0 0.0 0.1 0.1 5 -*00\n")
    fake.say(T.format(30, "off", "-"))
    rows = display.telemetry.wait(2, timeout_s=5)
    assert list(rows["tick"]) == [10, 30]
    assert (display.counts.lost, display.counts.damaged) == (1, 1)


def test_waiting_for_telemetry_that_does_not_come_says_what_streams(display: Display) -> None:
    with pytest.raises(TelemetryTimeout, match="telemetry streams every 10 ms"):
        display.telemetry.wait(timeout_s=0.1)
    display.stream(0)
    with pytest.raises(TelemetryTimeout, match="no telemetry streams"):
        display.telemetry.wait_for(lambda sample: True, timeout_s=0.1)


def test_events_keep_their_order_and_are_taken_by_kind(fake: FakeDevice, display: Display) -> None:
    for line in ("E 5 0 land", "E 9 0 start", "E 12 0 lift", "E 40 250 trigger"):
        fake.say(line)
    assert display.events.wait("lift").tick == 12
    assert display.events.wait().tick == 5
    assert [event.tick for event in (display.events.wait("start"), display.events.wait("trigger"))] == [9, 40]
    fake.say("E 50 0 land")
    until(lambda: display.events._log._events)
    display.events.clear()
    with pytest.raises(EventTimeout, match="no event 'land' within 0.1 s"):
        display.events.wait("land", timeout_s=0.1)


def test_callbacks_may_send_commands_and_may_fail(fake: FakeDevice, display: Display) -> None:
    states: list[State] = []

    def fails(event: Event) -> None:
        raise RuntimeError("in a callback")

    display.events.subscribe(fails)
    end = display.events.subscribe(lambda event: states.append(display.state().state), "land")
    fake.say("E 5 0 lift")
    fake.say("E 6 0 land")
    until(lambda: states)
    end()
    fake.say("E 7 0 land")
    display.events.wait("lift")
    until(lambda: len(display.events._log._events) == 2)
    assert states == [State.OFF]


def test_a_trip_is_told_and_ends_what_waits(fake: FakeDevice, display: Display) -> None:
    trips: list[Trip] = []
    display.on_trip(trips.append)
    display.check()
    fake.answers["cause"] = (
        "ok cause=dose tick=20 display_c=41.00 check_c=41.10 sink_c=24.00 current_a=1.50 asked_a=-1.50"
    )
    for tick in (10, 20, 30):
        fake.say(T.format(tick, "tripped" if tick > 10 else "stimulus", "dose" if tick > 10 else "-"))
    with pytest.raises(DeviceTripped, match=r"tripped by dose \(tick 20, display 41.00 °C") as error:
        display.events.wait("end", timeout_s=30)
    assert error.value.cause is not None and error.value.cause.asked_a == -1.5
    with pytest.raises(DeviceTripped):
        display.check()
    with pytest.raises(DeviceTripped):
        display.telemetry.wait_for(lambda sample: sample.force_n > 1, timeout_s=30)
    until(lambda: trips)
    assert [(trip.fault, trip.tick) for trip in trips] == [("dose", 20)]
    fake.answers["hold 30"] = "err hold needs a driven display: arm first"
    with pytest.raises(DeviceTripped) as refused:
        display.hold(30)
    assert isinstance(refused.value.__cause__, Refused)
    fake.say(T.format(40, "ready", "-"))
    until(lambda: display.trip is None)
    display.check()


def test_waiting_for_a_state_ends_by_timeout_and_by_a_trip(fake: FakeDevice, display: Display) -> None:
    with pytest.raises(StateTimeout, match="still 'off' after 0.1 s, instead of armed"):
        display.wait_state("armed", timeout_s=0.1)
    fake.state, fake.fault = "tripped", "comparator"
    with pytest.raises(DeviceTripped, match="tripped by comparator"):
        display.wait_state(State.ARMED, timeout_s=30)
    display.wait_state(State.TRIPPED)
