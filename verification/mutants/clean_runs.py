"""Runs of the unchanged tree: a failure there is a false alarm."""

import threading

import outcomes


class CleanRuns:
    """Runs of all tests on the clean tree, shared by the workers; earlier ones of the tree count.

    A single run with failures is followed by another, which tells false alarms from a broken tree.
    """

    def __init__(self, wanted, tree, revision):
        known = outcomes.stored(outcomes.CLEAN)
        if known is None or known["tree"] != tree:
            known = {"tree": tree, "revision": revision, "alarms": [], "seconds": {}}
        self._known, self._wanted = known, wanted
        self._running, self._lock = 0, threading.Lock()

    def missing(self):
        """The number of runs that have not been started."""
        alarms = self._known["alarms"]
        wanted = max(self._wanted, 2) if len(alarms) == 1 and alarms[0] else self._wanted
        return max(0, wanted - len(alarms) - self._running)

    def is_done(self):
        """Whether all requested runs are done."""
        with self._lock:
            return self.missing() == 0 and self._running == 0

    def work(self, worker):
        """Runs all tests in a worker's copy repeatedly, until no run is missing."""
        while self._begin():
            alarms, seconds = [], {}
            for program in worker.programs():
                failed, seconds[program.name] = worker.failures(program)
                alarms += failed
            self._end(alarms, seconds)

    def _begin(self):
        with self._lock:
            begins = self.missing() > 0
            self._running += begins
            return begins

    def _end(self, alarms, seconds):
        with self._lock:
            self._running -= 1
            self._known["alarms"].append(alarms)
            self._known["seconds"] |= seconds
            outcomes.store(outcomes.CLEAN, self._known)
            failed = f"{', '.join(alarms)} failed, " if alarms else ""
            told = f"run {len(self._known['alarms'])}, {failed}{sum(seconds.values()):.0f} s"
            print(f"clean tree: {told}", flush=True)

    def conclude(self):
        """Raises RuntimeError if a test failed in every run, as no verdict would be valid."""
        always = set.intersection(*map(set, self._known["alarms"]))
        if always:
            raise RuntimeError(f"the clean tree fails: {', '.join(sorted(always))}")
