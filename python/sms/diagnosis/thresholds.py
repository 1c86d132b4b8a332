"""Every tuning constant of the diagnosis, with its origin in a word.

Convention: customary in statistics. Published: the dissertation. Blind trials: set on trials with hidden effects
(docs/trials.md), so that right causes pass and imitations do not. Judgement: an engineer's choice that nothing here
measures. Run time, memory, numerics: what the computation asks for.

What depends on the rig stands with it (estimation/kind.py: `practically_significant`, `short`); what belongs to a
least-squares fit with the fit (estimation/least_squares.py, block_statistics.py).
"""

from __future__ import annotations

# ---- Excitation: what a motion must contain --------------------------------------------------------

PRESSURE_LEVELS = 1.5
"""Ratio of the largest to the smallest mean pressure of the records. Judgement: half as much again."""
SPEED_RATIO = 10.0
"""Ratio of fast to slow within one record. Judgement: a decade tells a slope or a Stribeck curve from a constant."""
TRAVEL_SHARE = 0.25
"""Share of the stroke that is travelled. Judgement."""
FAST_MOTION = 0.2
"""m/s: where friction was seen to rise again (dissertation, section 6.3)."""
LEAST_ACCELERATION = 0.5
"""m/s^2: below it the inertia of a cylinder's own parts is lost in its friction. Judgement."""
SMALL_OPENING = 1.0
"""V from the centre: up to here a dead band acts. Judgement."""
FAST_COMMAND = 5.0
"""V/s: slower commands hide a lag of milliseconds. Judgement."""

# ---- Identifiability -------------------------------------------------------------------------------

DETECTION = 3.0
"""Standard errors at which an effect counts as detectable. Convention: three sigma."""

# ---- Score test and the choice of what is fitted ---------------------------------------------------

SIGNIFICANT = 0.01
"""Largest chance, over all candidates of a round together, of naming one on data without any effect. Convention: 1 %.
"""
ALIKE = 0.95
"""Cosine of two sensitivities from which two effects cannot be told apart by them. Judgement."""
SAME = 0.999
"""The same before what is known is taken from them: one equation to these signals. Numerics: a sensitivity is right to
three digits.
"""


# ---- Judgement on the validation records -----------------------------------------------------------

WORTH = 0.01
"""Least share of the original squared error beyond the noise floor that a cause must take. Judgement."""
WORTH_OF_NOISE = 0.02
"""The same as a share of the noise floor itself, for a machine with hardly any error beyond it. Judgement."""
TELLS_APART = 3.0
"""Standard errors of the difference of two rivals, over windows, from which the worse is out. Convention: three sigma.
"""
TELLS_APART_IN_A_CROWD = 2.0
"""The same where a class would have more members than an answer should (MOST_MEMBERS). Convention: 95 percent."""

# ---- Forward selection and backward elimination ----------------------------------------------------

MOST_CAUSES = 4
"""More are not named. Judgement: with so many terms something always fits."""
UNKNOWN_OF_NOISE = 0.05
"""Least systematic error, as a share of the noise floor's square, for the verdict unknown. Judgement."""
UNKNOWN_CHANCE = 0.005
"""Largest chance of calling healthy data unknown, for each of two tests. Convention: 1 % in all."""

# ---- Stepwise selection on simulated rigs -----------------------------------------------------------

FINITE_STEPS = (0.01, 0.05, 0.2)
"""Of the way to either end of the plausible range: the sizes at which an effect is tried with all else held. Run time:
a factor of five apart, and least squares goes on from the best."""
REFINED = 0.3
"""Of the best gain of any size: with less, a size is not refined by least squares. Run time: a factor of five apart,
sizes show two thirds of what the best between them gains.
"""
STEPPED_ON = 3
"""Windows with the largest error on which finite steps are tried, and as many of all. Run time."""
TRIED_BY_STEP, TRIED_BY_SLOPE = 3, 3
"""Effects that are fitted in a round, by what finite steps and by what linear steps promise. Run time."""
CANDIDATE_STEPS = 2
"""Jacobians in the fit of a candidate, for each parameter that its effect has; that of the one that is chosen goes on.
Run time."""
LEADERS, PARTNERS = 3, 2
"""Effects of a round that are fitted two at a time where none stands alone: those that lower most, with each other, and
each with those that finite steps on top of it promise most of. Run time: nine pairs.
"""
PAIR_STEPS = 4
"""Jacobians in the fit of two effects: they have farther to go than one. Run time."""
LEAST_SHARE = 0.5
"""Of what is left beyond the noise: what a cause must take. Judgement: most of it."""
HELPS = 0.1
"""Of the same on the records that an effect was fitted to: with less it is not asked about on the validation records,
where it would have to take seven times as much to stand. Run time."""
NEARLY_ALL = 0.85
"""The same where what is left is within what is tolerated. Judgement: half of so small an error is imitated
by many effects, nearly all of it hardly by any."""
SURE = 5.0
"""Standard errors, systematic errors counted, by which an effect is beyond what is declared of it that is named for
taking most of what is left where that is within what is tolerated; and a cause that is missed for its size, where
records of the healthy machine told what is known. Convention: five sigma.
"""
JOINT_INTERVAL = 0.95
"""Of a cause, systematic errors counted: the interval that must not hold what is declared. Convention: 95 percent. A
single one may also take NEARLY_ALL of what is not tolerated.
"""
DEPARTS = 1e-3
"""Chance from which on the numbers that are known lie too far from what is declared for a healthy machine, however
little is left. Convention: 0.1 percent.
"""
TOLERATED = 0.1
"""Of the error that all declared uncertainties together would make: what a model may leave. Judgement: a description
whose numbers are known to a few percent, and which then fits ten times better than that, is not called wrong.
"""
LEAST_OF_NOISE = 0.1
"""Of the mean square that the model leaves on records of the healthy machine: what it may leave beyond that on others.
Judgement: the machine is the same, the runs are not."""
TWINS = 0.9
"""Cosine of two changes of all predictions from which two effects are one class, if neither is worse. Judgement."""

MOST_MEMBERS = 3
"""Of a class, where predictions change otherwise than the best's: an answer of more names is none. Convention: that of
the goals.
"""

# ---- Lack of fit -----------------------------------------------------------------------------------

LEFT = 0.1
"""Of the baseline's lack of fit: with more left, the verdict is unknown. Blind trials: right causes leave some
percent.

The more, the further the real law is from the core's.
"""

# ---- Parameter constancy and hysteresis ------------------------------------------------------------

APART = 10.0
"""Standard errors by which a play is there, and by which a cause shrinks beside it. Blind trials."""
APART_BY = 0.2
"""Of the size itself: how far the sizes of one cause are apart, at the least, in a law of its own. Judgement: no law of
friction or flow is right to the last tenth everywhere."""
PLAY = 0.02
"""V to either side, for which the sensitivity is taken. Judgement: above a command's noise, below a dead band."""

LEAST_PLAY = 2.4e-3
"""V: one step of a converter of 12 bits over 10 V. A play below it is none: no command is that fine."""

# ---- Record consistency ----------------------------------------------------------------------------

TRIED_BY_RECORD = 3
"""Effects that are fitted record by record: those that promise most. Run time."""
EXPLAINS = 0.8
"""Of the lack of fit: what one effect with a value of its own in each record has to take, and none with one value for
all. Trials with bad input.
"""
DIFFERS = 6.0
"""Standard errors between two records' values. Trials with bad input."""
DIFFERS_BY = 0.4
"""Of the largest shift: by how much the values differ at the least. Trials with bad input."""

# ---- Systematic errors -------------------------------------------------------------------------------

BENDS = 0.5
"""Of a signal's range: the length along it over which an error of a law changes. Judgement: laws of friction and flow
are smooth, and what is off in them too."""

# ---- Free runs over whole records ----------------------------------------------------------------------

INSIDE = 4.0
"""Standard deviations of the noise by which a record has to keep from the ends of the stroke, where a simulation that
goes beyond them is said to leave it. Convention: noise alone goes so far once in thirty thousand samples."""

# ---- Unknown inputs --------------------------------------------------------------------------------

PIECES = 7
"""Values of a function of one signal. Judgement."""
MOVES = 20.0
"""Standard deviations of its noise over which a signal must range. Judgement."""
DRAWS = 199
"""Resamples behind an interval. Convention: the 95 % limits are order statistics of 199."""
CURVE_RIDGE = 1e-3
"""Ridge of the curves, of the mean diagonal of their normal equations. Judgement."""
MOST_ROWS = 16_000
"""Rows of a sensitivity: with more, neighbouring samples are added up. Memory."""
CANNOT = 0.01
"""Of a sensitivity's square: what unknown inputs may miss. Judgement: a sensor's error or a delay they cannot make."""
INPUT_RIDGE = 1e-6
"""Ridge of the inputs at the knots, of the same. Numerics."""

# ---- Equation error --------------------------------------------------------------------------------

SMOOTHING = 0.05
"""s: window of the local cubics. Judgement: the knots of the unknown inputs are as far apart."""
AVERAGE = 0.1
"""s: an error is the mean over this time. Judgement: two windows of the smoother."""
STRETCH = 1.0
"""s: the block that is resampled. As long as a window of the simulation."""
ENDS = 0.1
"""s left out at either end of a record, where the smoother is one-sided and the spool starts from rest. Judgement."""
TOLERANCE = 5.0
"""Mean square beyond the noise's, in the worst equation, from which shares are practically significant. Blind trials.

Two fair descriptions of one machine differ by 1.5 in friction through rest; noise that is not white adds up to 4.
"""

# ---- Residual spectrum and period along the stroke -------------------------------------------------

POWER_SHARE = 0.8
"""Of the power beyond the noise: what lies below the frequency that is reported. Convention."""
PERIODS_IN_TRAVEL = 5.0
"""Least number of periods within the travel. Judgement."""
SHORTEST_PERIOD = 1e-3
"""m. Judgement: finer than any thread or tooth of the rig."""
PROMINENCE = 4.0
"""Peak over the median of the spectrum, in the mean over all records and directions. Judgement."""
AGREEMENT = 0.05
"""Relative difference of the period between records and directions. Judgement."""

# ---- Next experiment -------------------------------------------------------------------------------

SAME_RUN = 0.3
"""Of a motion, within which a record is of the same run of a menu. Judgement: two of a menu differ by 0.6 and more or
are made under other conditions, a machine follows its fitted model within a tenth.
"""
SAME_CONDITIONS = 0.1
"""Of what was changed on purpose (a mass, the supply): within that, it is the same change. Judgement."""

# ---- A model of one's own --------------------------------------------------------------------------

FEWEST_WINDOWS = 6
"""Windows of a role. Judgement: fewer give no scatter between windows."""
DIFFERENCE = 1e-5
"""Of a number's scale: the step of a central difference. Numerics: near the cube root of the rounding error."""
INTEGRATION_ERROR = 1.0
"""Standard errors by which half the step of the integration may move an estimate at the most. Judgement."""
MOST_HALVINGS = 6
"""Of a sample's length, until then. Run time."""
