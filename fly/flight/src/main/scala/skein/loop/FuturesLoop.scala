package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.stream.SharedKillSwitch
import org.apache.pekko.stream.scaladsl.{RunnableGraph, Source}
import scala.concurrent.{ExecutionContext, Future}
import skein.record.EventKind
import skein.units.*

/** The paper's model 3: every period one future per vehicle, which reads all vehicles in sequence, decides
  * for its own and commands it. Futures may overlap; their decisions take effect in the order in which they
  * finish.
  */
object FuturesLoop:

  def apply(team: Team, stop: SharedKillSwitch)(using ExecutionContext): RunnableGraph[Future[Done]] =
    val steps = Source
      .tick(Span.Zero.toDuration, team.settings.period.toDuration, 1)
      .conflate(_ + _)
      .mapConcat: ticks =>
        if ticks > 1 then
          team.log.note(EventKind.Skipped, None, s"${ticks - 1} steps missed: too many futures run")
        team.own
      .mapAsyncUnordered(team.settings.window * team.own.size)(vehicle =>
        team.readAll().map(_.map(LoopEvent.Seen(_, Set(vehicle))))
      )
      .collect { case Right(seen) => seen }
    SnapshotGraph(team, steps.via(stop.flow), stop)
