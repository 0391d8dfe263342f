package rovers

import skein.loop.{LoopEvent, OwnLoop, SnapshotGraph}

/** A loop of its own: once a period all robots report their states, and one of them decides, in turns. */
val turns = OwnLoop(
  "turns",
  (team, stop) =>
    val snapshots = team
      .ticks(team.now)
      .mapAsync(1)(_ => team.readAll())
      .collect { case Right(readings) => readings }
      .zipWithIndex
      .map((readings, turn) => LoopEvent.Seen(readings, Set((turn % team.vehicles.size).toInt)))
    SnapshotGraph(team, snapshots.via(stop.flow), stop)
)
