"""Marks of the sketches: title, height in pixels, and a line for every mark (:mod:`sketches` draws the marks)."""

from __future__ import annotations

from collections.abc import Mapping

SKETCHES: Mapping[str, tuple[str, int, str]] = {
    "bodies": (
        "Bodies that are fixed, free, slide and turn",
        130,
        """
        solid M20,40h60v30h-60z
        ground 20 70 60 0
        dot 50 55 3
        middle 50 118 fixed
        solid M120,35l50,10l-8,35l-50,-10z
        dot 140 58 3
        middle 145 118 free
        solid M222,38h50v26h-50z
        line M205,68H290
        line M205,34H290
        dot 247 51 3
        load M250,20h30
        middle 247 118 slides
        solid M330,75l-8,-38l22,-5l8,38z
        ground 318 86 40 0
        line M330,86L338,68L346,86
        pin 338 66 5
        load M352,42A22,22,0,0,0,330,22
        middle 338 118 turns
        """,
    ),
    "beams": (
        "A beam with constant and with varying thickness, and its section",
        140,
        """
        ground 14 75 50 -90
        strip M14,42H230V58H14z
        rest M14,50H240
        span M120,40V60
        middle 120 30 thickness
        ground 14 135 40 -90
        strip M14,104L230,111V119L14,126z
        rest M14,115H240
        start 150 95 at, values
        strip M300,80h60v20h-60z
        span M290,80v20
        span M300,112h60
        middle 330 130 width
        middle 330 68 section
        """,
    ),
    "curves": (
        "A line, an arc, a polynomial and a spline",
        130,
        """
        beam M15,80L95,40
        dot 15 80 4
        dot 95 40 4
        middle 55 118 line
        beam M120,80A45,45,0,0,1,200,80
        rest M120,80L160,95L200,80
        dot 160 95 3
        middle 160 118 arc
        axis M218,90V30
        axis M218,90H305
        beam M225,80Q265,5,295,60
        end 216 24 y
        start 306 104 x
        middle 262 118 polynomial
        beam M318,70C330,20,345,30,352,55S375,90,390,35
        dot 318 70 4
        dot 336 33 4
        dot 355 64 4
        dot 390 35 4
        middle 354 118 spline
        """,
    ),
    "imperfection": (
        "A beam with an imperfection of two half waves",
        110,
        """
        rest M30,55H370
        beam M30,55C87,5,143,5,200,55S313,105,370,55
        span M115,18V55
        middle 115 84 amplitude
        axis M340,55H394
        end 394 46 beam
        dot 30 55 4
        dot 370 55 4
        middle 115 102 1st half wave
        middle 285 45 2nd half wave
        """,
    ),
    "ends": (
        "A welded end, a pinned end and a free end",
        105,
        """
        ground 20 75 50 -90
        beam M20,50H110
        middle 65 98 weld
        solid M150,35h24v30h-24z
        ground 150 65 24 0
        beam M166,50L250,30
        pin 166 50 6
        middle 205 98 pin
        ground 290 75 50 -90
        beam M290,50H365
        dot 365 50 4
        start 370 44 tip
        middle 330 98 free
        """,
    ),
    "pins": (
        "A pin between two bodies",
        90,
        """
        solid M60,30L200,45L198,61L58,46z
        solid M200,43L340,26L342,42L202,61z
        pin 200 52 6
        middle 200 84 A, B
        start 64 22 body
        end 340 20 body
        """,
    ),
    "stops": (
        "The angle of a stop between the pin, another point of the body and the beam",
        150,
        """
        ground 100 120 200 0
        solid M100,105h200v15h-200z
        line M130,105H280
        beam M130,105L205,25
        rest M130,105L290,70
        rest M130,105L118,20
        pin 130 105 6
        dot 280 105 4
        load M235,105A105,105,0,0,0,204,32
        start 232 54 angle
        middle 280 98 towards
        start 294 72 least
        end 112 28 most
        end 192 22 beam
        """,
    ),
    "assembly": (
        "The three parts of an assembly",
        130,
        """
        ground 12 60 40 -90
        rest M12,40H105
        beam M12,40Q60,40,95,18
        load M108,36A16,16,0,0,0,86,10
        pin 85 60 4
        middle 60 100 1. moments
        ground 148 60 40 -90
        beam M148,40Q195,40,221,60
        load M236,22L224,52
        pin 221 60 5
        middle 195 100 2. ends to points
        ground 288 60 40 -90
        beam M288,40Q340,20,361,60
        pin 361 60 5
        middle 335 100 3. moments to 0
        """,
    ),
    "loads": (
        "A moment, a force, a moment and a force on a beam, and a distributed load",
        130,
        """
        solid M18,45h36v30h-36z
        load M56,44A24,24,0,0,0,18,40
        middle 36 118 moment
        solid M88,45h36v30h-36z
        dot 106 60 3
        load M106,10V54
        middle 106 118 force
        beam M140,60H205
        load M190,72A20,20,0,1,0,158,74
        middle 172 104 beam_
        middle 172 118 moment
        beam M225,60H295
        load M262,10V54
        middle 260 104 beam_
        middle 260 118 force
        beam M312,60H392
        line M332,22H378
        load M332,22V54
        load M347,22V54
        load M362,22V54
        load M378,22V54
        middle 352 118 distributed
        """,
    ),
    "drives": (
        "A driven displacement and a driven rotation",
        110,
        """
        ground 20 70 40 -90
        rest M20,50H130
        beam M20,50Q85,50,125,85
        dot 125 85 4
        load M130,50V80
        start 138 70 direction
        dot 130 50 3
        end 118 30 point
        ground 240 70 40 -90
        rest M240,50H335
        beam M240,50Q300,50,328,25
        solid M322,12l16,12l-10,14l-16,-12z
        load M372,52A40,40,0,0,0,352,14
        start 350 76 body
        """,
    ),
    "from": (
        "A drive from the second of three stages on",
        110,
        """
        line M30,80H380
        line M145,14V86
        line M265,14V86
        middle 87 102 press
        middle 205 102 hold
        middle 322 102 lift
        rest M30,75Q90,70,145,45
        beam M145,45H265L370,20
        start 36 26 free
        start 152 26 holds its value
        start 272 66 goes on
        """,
    ),
    "beam-contacts": (
        "Two beams by their edges, two beams as lines, and a beam with itself",
        120,
        """
        strip M15,30Q70,38,130,30V42Q70,50,15,42z
        strip M15,62Q70,43,130,62V74Q70,55,15,74z
        dot 72 50 3
        middle 72 108 thick
        slim M160,30Q215,60,265,30
        slim M160,62Q215,30,265,62
        dot 212 46 3
        middle 212 108 thick = false
        beam M300,70Q385,70,385,40Q385,14,348,14T314,40Q314,54,325,63
        dot 325 67 3
        middle 345 108 beam-self
        """,
    ),
    "edges": (
        "Rigid edges: circle, hole, ellipse, half-plane, line, function, spline",
        250,
        """
        disc 55 62 26
        beam M12,33H100
        middle 55 112 circle
        solid M118,20h74v74h-74z
        pin 155 57 30
        beam M128,48Q155,100,182,60
        middle 155 112 circle inside
        solid M220,70A34,20,-20,1,1,284,48A34,20,-20,1,1,220,70z
        beam M208,40Q240,34,290,20
        middle 250 112 ellipse
        solid M312,60L392,50V94H312z
        line M312,60L392,50
        load M352,54L348,24
        end 342 30 normal
        middle 352 112 half-plane
        solid M20,195L55,165L100,190L92,214L57,188L28,214z
        line M20,195L55,165L100,190
        beam M14,166Q55,148,110,164
        middle 60 240 line
        solid M150,200Q200,135,250,200V216Q200,151,150,216z
        line M150,200Q200,135,250,200
        middle 200 150 above: free
        middle 200 240 function
        solid M310,190C330,160,350,200,385,165L390,182C355,217,335,177,315,206z
        line M310,190C330,160,350,200,385,165
        dot 310 190 3
        dot 345 181 3
        dot 385 165 3
        middle 348 240 spline
        middle 348 152 left: free
        """,
    ),
    "overlap": (
        "Two beams that overlap as drawn by rounded coordinates",
        90,
        """
        strip M30,20H250V44H30z
        strip M90,41H330V65H90z
        span M345,41v3
        line M252,44H340
        line M332,41H350
        start 290 34 overlap
        middle 180 84 at most 0.1 % of the mean thickness
        """,
    ),
    "may-cross": (
        "Two beams in different planes",
        100,
        """
        ground 30 70 40 -90
        beam M30,50H350
        ground 180 94 40 0
        rest M200,92V62
        beam M200,92V56
        beam M200,44V10
        start 210 22 behind the bar
        start 300 42 bar
        """,
    ),
    "stages": (
        "Force and displacement with stations, a fold, and the two answers beyond the fold",
        150,
        """
        axis M40,130V12
        axis M40,130H385
        start 48 20 load
        end 385 146 displacement
        beam M40,130Q80,40,150,40
        rest M150,40Q210,40,225,75T300,72
        beam M300,72L360,24
        load M154,40H328
        dot 62 92 4
        dot 90 60 4
        dot 150 40 5
        dot 332 46 4
        start 98 74 stations
        middle 150 28 stop
        middle 250 33 jump
        """,
    ),
    "probes": (
        "Parts of a mechanism and their quantities",
        150,
        """
        ground 20 95 60 -90
        beam M20,65Q180,65,300,95
        solid M296,82l36,10l-6,24l-36,-10z
        dot 312 100 4
        disc 150 96 22
        load M150,74V40
        middle 150 34 contact: force, centre
        start 28 110 point:
        start 28 126 reaction
        start 250 140 body: rotation
        end 396 74 point: displacement
        start 166 58 beam: stress
        """,
    ),
    "paper": (
        "Boundary beam, axis of the gap and related joints of the formulation paper",
        120,
        """
        slim M20,95Q200,30,380,95
        slim M20,25Q200,70,380,20
        dot 110 43 3
        dot 155 47 3
        dot 200 48 3
        dot 245 47 3
        dot 290 42 3
        span M155,47V66
        start 162 62 gap along y
        middle 200 112 boundary: fitted function
        middle 200 22 related joints: range of x
        rest M100,10V86
        rest M300,10V86
        """,
    ),
    "supports": (
        "A slider on a leaf spring under a weight, and a strip on two rollers under a punch",
        120,
        """
        ground 14 90 40 -90
        beam M14,70H150
        solid M85,20h30v38h-30z
        disc 100 58 9
        line M80,15V50
        line M120,15V50
        load M100,0V18
        start 124 14 weight
        middle 80 112 slider
        beam M210,66H380
        disc 240 80 11
        disc 350 80 11
        disc 295 52 11
        load M295,8V40
        start 304 22 punch
        middle 295 112 strip
        """,
    ),
}
