package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.*
import org.apache.pekko.stream.scaladsl.*
import org.apache.pekko.{Done, NotUsed}
import scala.concurrent.Future

/** [[PredictiveLoop]] with planning: for the vehicles of a [[JointPlanning]], thousands of manoeuvres are
  * simulated from the estimates of each tick until the deadline, each vehicle's against the plans of all
  * other vehicles, and the first actions of the best ones are commanded. Estimates are for the moment at
  * which those commands take effect. All other vehicles decide as in [[PredictiveLoop]].
  */
object PlanLoop:

  def apply(team: Team, stop: SharedKillSwitch)(using ActorSystem): RunnableGraph[Future[Done]] =
    team.planning.fold(PredictiveLoop(team, stop))(planning(team, _, stop))

  private def planning(team: Team, planning: JointPlanning, stop: SharedKillSwitch)(using ActorSystem) =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => end =>
      import GraphDSL.Implicits.*
      val single   = team.vehicles.filterNot(planning.vehicles.contains)
      val lead     = team.settings.planning.deadline + planning.deadTime
      val observed = builder.add(Observed(team, stop))
      val cast     = builder.add(team.cast(single.size + 1))
      val planned  =
        builder.add(Broadcast[Vector[Decision]](planning.vehicles.size).addAttributes(team.named("planned")))
      val steered = builder.add(team.steered)
      val fan     = builder.add(team.fan)

      observed ~> cast
      // The end overtakes waiting decisions: a vehicle that cannot be commanded accepts none of them.
      for vehicle <- single do
        cast ~> PredictiveLoop.newest(team, Some(vehicle)) ~> team.predict(vehicle) ~>
          team.decide(vehicle).via(stop.flow) ~> team.steer(vehicle) ~> steered.in(vehicle)

      cast ~> PredictiveLoop.newest(team, None) ~> team.predict(
        planning.vehicles,
        lead
      ) ~> team.plan(planning) ~>
        planned
      for vehicle <- planning.vehicles do
        // A command that cannot leave yet does not hold up the next plan.
        planned ~> only(vehicle) ~> team.newest(vehicle).via(stop.flow) ~> team.steer(vehicle) ~>
          steered.in(vehicle)

      steered ~> fan
      fan ~> team.record
      fan ~> team.told ~> team.feedBackAll ~> observed
      fan ~> end
      ClosedShape
    })

  private def only(vehicle: Int): Flow[Vector[Decision], Decision, NotUsed] =
    Flow[Vector[Decision]].mapConcat(_.filter(_.vehicle == vehicle))
