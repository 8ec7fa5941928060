"""Answers as files: everything that a solver handed back, so that no report needs a second solve."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from comparisons.plain import Plain, plain
from cprbm_scene import Answer, Certificate, Critical, Ending, Event, GoneOver, Loss, Shape, StationAnswer
from cprbm_scene.answer import Array, BeamState, ContactState, PointForces, frozen_array
from cprbm_scene.frozendict import frozendict

Record = (
    BeamState | PointForces | ContactState | Critical | Event | Shape | Certificate
)  # a record whose fields are plain data


def text(answers: Mapping[str, Answer]) -> str:
    """Answers by name as JSON in one line: there are too many numbers for a line each."""
    return json.dumps({name: packed(answer) for name, answer in answers.items()}, ensure_ascii=False, allow_nan=False)


def packed(answer: Answer) -> Plain:
    """An answer as plain data; a number that is not finite becomes null."""
    found: Plain = plain(
        {
            "solver": answer.solver,
            "scene": answer.scene,
            "settings": answer.settings,
            "ending": answer.ending.name,
            "sentence": answer.sentence,
            "seconds": answer.seconds,
            "notes": answer.notes,
            "events": [_fields(event) for event in answer.events],
            "critical": [_packed_critical(critical) for critical in answer.critical],
            "gone_over": [{"end": _packed_critical(one.end), "turned": one.turned} for one in answer.gone_over],
            "stations": [
                {
                    "stage": station.stage,
                    "value": station.value,
                    "branch": station.branch,
                    "values": station.values,
                    "shapes": {name: _fields(shape) for name, shape in station.shapes.items()},
                    "touching": station.touching,
                    "certificate": _fields(station.certificate),
                    "beams": {name: _fields(beam) for name, beam in station.beams.items()},
                    "forces": _fields(station.forces),
                    "contacts": {name: _fields(contact) for name, contact in station.contacts.items()},
                    "bodies": station.bodies,
                }
                for station in answer.stations
            ],
        }
    )
    return found


def _packed_critical(critical: Critical) -> Plain:
    return {**_fields(critical), "loss": critical.loss.name}


def _fields(record: Record) -> Plain:
    return {field.name: getattr(record, field.name) for field in fields(record)}


def unpacked(data: Plain) -> Answer:
    """The answer that :func:`packed` made plain.

    Raises:
        KeyError: something is missing in ``data``.
    """
    return Answer(
        solver=data["solver"],
        scene=data["scene"],
        settings=frozendict(data["settings"]),
        ending=Ending[data["ending"]],
        sentence=data["sentence"],
        stations=tuple(_unpacked_station(station) for station in data["stations"]),
        events=tuple(_unpacked_event(event) for event in data["events"]),
        critical=tuple(_unpacked_critical(critical) for critical in data["critical"]),
        # archives of before have none
        gone_over=tuple(GoneOver(_unpacked_critical(one["end"]), one["turned"]) for one in data.get("gone_over", ())),
        seconds=data["seconds"],
        notes=tuple(data["notes"]),
    )


def _unpacked_event(data: Plain) -> Event:
    interval = data["interval"]
    return Event(**{**data, "interval": None if interval is None else tuple(interval)})


def _unpacked_critical(data: Plain) -> Critical:
    found: dict[str, Any] = {
        name: math.nan if value is None and name != "after" else value for name, value in data.items()
    }
    return Critical(**{**found, "loss": Loss[data["loss"]]})


def _unpacked_station(data: Plain) -> StationAnswer:
    certificate: dict[str, Any] = {
        name: math.nan if value is None else tuple(value) if isinstance(value, list) else value
        for name, value in data["certificate"].items()
    }
    return StationAnswer(
        stage=data["stage"],
        value=data["value"],
        values=frozendict({name: _array(values) for name, values in data["values"].items()}),
        shapes=frozendict(
            {
                name: Shape(_array(shape["s"]), _array(shape["x"]), _array(shape["y"]))
                for name, shape in data["shapes"].items()
            }
        ),
        touching=frozendict({name: _pairs(places) for name, places in data["touching"].items()}),
        certificate=Certificate(**certificate),
        branch=data["branch"],
        beams=frozendict({name: BeamState(*map(_array, beam.values())) for name, beam in data["beams"].items()}),
        forces=_unpacked_forces(data["forces"]),
        contacts=frozendict(
            {
                name: ContactState(contact["active"], _pairs(contact["places"]), contact["indeterminate"])
                for name, contact in data["contacts"].items()
            }
        ),
        bodies=frozendict({name: _array(values) for name, values in data["bodies"].items()}),
    )


def _unpacked_forces(data: Plain) -> PointForces:
    return PointForces(
        tuple(data["source"]),
        tuple(data["target"]),
        _array(data["s"]),
        _pairs(data["place"]),
        _pairs(data["force"]),
        _array(data["moment"]),
    )


def _pairs(values: list[Any]) -> Array:
    return frozen_array(np.reshape(_array(values), (-1, 2)))


def _array(values: list[Any]) -> Array:  # touching places are lists of pairs
    return frozen_array([math.nan if value is None else value for value in values])
