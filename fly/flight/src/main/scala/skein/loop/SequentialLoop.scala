package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.SharedKillSwitch
import org.apache.pekko.stream.scaladsl.{RunnableGraph, Source}
import scala.concurrent.Future
import skein.units.*

/** The paper's model 2: reads every vehicle in sequence, decides for all, commands all, waits one period. */
object SequentialLoop:

  def apply(team: Team, stop: SharedKillSwitch)(using system: ActorSystem): RunnableGraph[Future[Done]] =
    import system.dispatcher
    val steps = Source
      .unfoldAsync(Span.Zero)(pause =>
        after(pause.toDuration, system.scheduler)(team.readAll()).map(readings =>
          Some((team.settings.period, readings))
        )
      )
      .collect { case Right(readings) => LoopEvent.Seen(readings, team.own.toSet) }
    SnapshotGraph(team, steps.via(stop.flow), stop)
