package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.SharedKillSwitch
import org.apache.pekko.stream.scaladsl.RunnableGraph
import scala.concurrent.Future

/** [[PredictiveLoop]] that plans: for vehicles that have a [[Planning]], thousands of manoeuvres are flown forward from
  * the estimates of each tick until the deadline, and the best one's first action is commanded. Estimates are of the
  * moment at which that command will act. All other vehicles decide as in [[PredictiveLoop]].
  */
object PlanLoop:

  def apply(team: Team, stop: SharedKillSwitch)(using ActorSystem): RunnableGraph[Future[Done]] =
    PredictiveLoop.of(team, stop): vehicle =>
      team.planning(vehicle) match
        case Some(planning) =>
          team
            .predict(vehicle, lead = team.settings.planning.deadline + planning.deadTime)
            .via(team.plan(vehicle, planning))
            // A command that cannot leave yet does not hold up the next plan.
            .via(team.newest(vehicle))
        case None => team.predict(vehicle).via(team.decide(vehicle))
