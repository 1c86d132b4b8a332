"""A watch beside a machine: the model runs along with the rows that come in, and an alarm says what changed.

    rows       source.py, can_source.py  a played file, a growing one, a bus, through a queue that is bounded (feed.py)
    segments   segments.py     five windows of a second each; a gap, a restart, a reading that is none are states of
                               the stream, and no alarms
    scores     innovations.py  what a diagnosis works out of a record (windows from initial states of their own,
                               residuals whitened with the discrepancy, sensitivities to every effect), summed
    healthy    healthy.py      the same of the machine when it is well: its numbers, and how its scores scatter
    looks      detector.py     generalised likelihood ratio over the time since when something has changed
    alarms     alarm.py        since when, which equation or signal, which effects fit and how large (log.py)
    diagnosis  excerpt.py, background.py  a full diagnosis of the recorded rows, in a process of its own

`watch.py` holds these together; `terminal.py` and `page.py` show it. Whoever shows is given what there is and may lose
it; nothing that shows can hold up the watch.

Three things are as they are for a reason:

- Everything is judged against what the same machine left when it was well, and by how much that scattered over
  stretches of up to forty seconds, never against the declared noise. A machine that the model fits roughly has
  large scores when it is well, and only what goes beyond them counts.
- For what no effect explains, energies of the innovations go through the same likelihood ratio as the effects, not
  through a CUSUM: that needs the size of the change beforehand, and a second threshold with an origin of its own.
- The threshold is a tail of Student's distribution divided among all that is looked at (detector.py), not a quantile
  of resampled healthy segments: half an alarm a day is one segment in 35,000, and ten minutes hold 120.
"""
