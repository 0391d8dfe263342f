package skein.loop

import org.apache.pekko.{Done, NotUsed}
import org.apache.pekko.stream.*
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import skein.flow.Newest
import skein.record.{Decision, EventKind}

/** [[StreamLoop]] that decides upon the future: each observation is carried forward to the moment at which the command
  * will act, by simulating every vehicle under the commands on their way to it. What the answers to commands tell is
  * fed back besides the commands themselves.
  */
object PredictiveLoop:

  def apply(team: Team, stop: SharedKillSwitch): RunnableGraph[Future[Done]] = of(team, stop, together = None)

  /** @param together
    *   vehicles whose decisions are made together, and how, upon the sights of each tick; all others decide each for
    *   themselves
    */
  private[loop] def of(
      team: Team,
      stop: SharedKillSwitch,
      together: Option[(Vector[Int], Flow[Sight, Vector[(Int, Decision)], ?])]
  ): RunnableGraph[Future[Done]] =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => done =>
      import GraphDSL.Implicits.*
      val single   = team.vehicles.filterNot(together.fold(Vector.empty)(_._1).contains)
      val percepts = builder.add(MergePreferred[Percept](team.vehicles.size + 1, eagerComplete = true))
      val everyone = builder.add(Broadcast[Sight](single.size + together.size))
      val heard    = builder.add(Merge[Percept](team.vehicles.size))
      val fed      = builder.add(Broadcast[Percept](2))

      val start = team.now

      for vehicle <- team.vehicles do
        StreamLoop.locations(team, vehicle, start, stop).map(Percept.Read(_, _)) ~> percepts.in(vehicle)

      for vehicle <- single do
        everyone ~> newest(team, Some(vehicle)) ~> team.predict(vehicle) ~> team.decide(vehicle) ~>
          team.steer(vehicle) ~> heard.in(vehicle)

      for (vehicles, decisions) <- together do
        val decided = builder.add(Broadcast[Vector[(Int, Decision)]](vehicles.size))
        everyone ~> newest(team, None) ~> decisions ~> decided
        for vehicle <- vehicles do
          decided ~> of(vehicle) ~>
            // A command that cannot leave yet does not hold up the next plan.
            team.newest(vehicle) ~> team.steer(vehicle) ~> heard.in(vehicle)

      team.due(start).via(stop.flow) ~> percepts.in(team.vehicles.size)
      percepts ~> team.pictureWithForecast ~> everyone
      heard ~> fed ~> team.feedBackAll ~> percepts.preferred
      fed ~> done
      ClosedShape
    })

  private def of(vehicle: Int): Flow[Vector[(Int, Decision)], Decision, NotUsed] =
    Flow[Vector[(Int, Decision)]].mapConcat(_.collect { case (`vehicle`, decision) => decision })

  /** A prediction is made for the moment of its decision: when the command can leave. */
  private def newest(team: Team, vehicle: Option[Int]) =
    Newest[Sight](_ => team.log.note(EventKind.Dropped, vehicle, "not commanded within a period"))
