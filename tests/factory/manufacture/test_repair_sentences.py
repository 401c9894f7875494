"""A repair is a type that goes into a report and back; its sentence follows from it."""

import json

import pytest

from asset_factory.factory.manufacture.repair import Repair, RepairKind, older_repair

TOLD = (
    (
        Repair(RepairKind.CONTACT_EXCLUDED, pairs=(("a", "b"), ("a", "c"))),
        "excluded from contact in MuJoCo, as other engines do: a and b, a and c",
    ),
    (
        Repair(RepairKind.CLOSED_END_PULLED_IN, ("lid",), (), ("hinge",), -0.25, -0.125, "rad"),
        "began hinge at -0.125 instead of -0.25 rad: closed further it lies in something",
    ),
    (
        Repair(RepairKind.FRONTS_BUILT_AT_ONCE, ("door", "drawer"), before=31_000, unit="faces"),
        "built fronts and body anew, of 31000 faces: door, drawer",
    ),
    (
        Repair(RepairKind.AXIS_STRAIGHTENED, joints=("hinge",), before=4.04, free_share=0.5),
        "mended hinge: its axis was 4.0 degrees off a principal direction; "
        "it ran into something after 50%",
    ),
    (
        Repair(RepairKind.AXIS_SQUARED, joints=("hinge",), before=9.96),
        "mended hinge: its axis was 10.0 degrees off every edge of its box",
    ),
    (
        Repair(RepairKind.OVERLAPPING_GIVEN_UP, ("b", "a", "c"), joints=("b_hinge",)),
        "gave up b_hinge: b lies in a and c",
    ),
    (
        Repair(RepairKind.JOINT_FROZEN, joints=("button",), free_share=0.1),
        "froze button: it runs into something after 10% of its range",
    ),
)


@pytest.mark.parametrize(("repair", "sentence"), TOLD, ids=lambda value: getattr(value, "kind", ""))
def test_a_repair_tells_its_sentence_and_survives_a_report(repair, sentence):
    assert repair.sentence == sentence
    assert Repair.from_dict(json.loads(json.dumps(repair.to_dict()))) == repair


def test_every_kind_has_a_label_and_a_sentence():
    for kind in RepairKind:
        repair = Repair(kind, ("a",), (("a", "b"),), ("j",), 1.0, 0.0, "m", 0.5, why="it jams")
        assert kind.label
        assert repair.sentence


def test_a_report_that_holds_sentences_alone_still_tells_kinds():
    sentences = ["cut the hulls apart of a and b", "left what is open in a open: ...", "who knows"]
    repairs = [older_repair(sentence) for sentence in sentences]
    assert [repair.sentence for repair in repairs] == sentences
    kinds = [RepairKind.HULLS_CUT_APART, RepairKind.LEFT_HOLLOW, RepairKind.OTHER]
    assert [repair.kind for repair in repairs] == kinds


@pytest.mark.parametrize("damaged", [{}, {"kind": "none"}, {"kind": "other", "pairs": ["a"]}, []])
def test_what_is_no_repair_is_refused(damaged):
    with pytest.raises((KeyError, TypeError, ValueError)):
        Repair.from_dict(damaged)
