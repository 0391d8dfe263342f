package skein.report

import scala.util.Random
import skein.policy.{Agent, Fleet, HeadingPolicy}
import skein.record.*
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.units.*

/** A recording of the paper's duel between vehicles that follow their commanded velocity with a first-order
  * lag of 0.8 s, observed through a link's round trips. It has the form of a real flight; its figures are
  * invented.
  */
object SyntheticFlight:
  private val step   = Span.ofMillis(5)
  private val start  = Instant.ofNanos(1_790_000_000_000_000_000L)
  private val offset = Span.ofSeconds(1_789_000_000.25)

  def apply(loop: String, link: String, seed: Long, seconds: Int = 60): Recording =
    val scenario = PaperDuel().fleet
    val random   = Random(seed)
    val profile  = LatencyProfile.parse(link, Left(_)) match
      case Right(LatencyProfile.Steady(_, roundTrip)) => roundTrip
      case other                                      => sys.error(s"no steady link: $other")
    def roundTrip() = profile.quantile(random.nextDouble())
    val recorder    = MemoryRecorder(heading(loop, link, seed, seconds, scenario))
    val agents      = scenario.agents.indices
    val period      = if loop == "sequential" then 20 + (profile.mean.toMillis * 2 / 5).toInt else 20
    var positions   = scenario.agents.map(_.startPositionNed)
    var velocities  = scenario.agents.map(_ => Vector3.Zero)
    val headings    = scenario.agents.map(_.startHeading.value).toArray
    val commanded   = scenario.agents.map(_ => Vector3.Zero).toArray
    var pending     = Vector.empty[(Instant, Int, Vector3)]
    var lastSent    = Vector.fill[Option[Instant]](agents.size)(None)
    for tick <- 0 until seconds * 200 do
      val now          = start + step * tick
      val (due, later) = pending.partition(_._1 <= now)
      due.foreach((_, agent, velocity) => commanded(agent) = velocity)
      pending = later
      if tick % period == 0 then
        val sequence = (tick / period).toLong
        val trips    = agents.map(_ => roundTrip())
        val decided  = now + trips.max + Span.ofMillis(random.nextDouble() * 3)
        val readings = agents.map: agent =>
          ReadingRow(
            sequence,
            scenario.agents(agent).name,
            Stamped(
              Kinematics(positions(agent), velocities(agent), Quaternion.Identity, Vector3.Zero),
              now - offset,
              now - trips(agent) / 2,
              now + trips(agent) / 2
            )
          )
        readings.foreach(recorder.offer)
        trips.foreach(trip => recorder.offer(Latency(link, now, trip)))
        for agent <- agents do
          val decision = decide(scenario, agent, sequence, readings, headings.toVector, decided, lastSent)
          recorder.offer(decision)
          headings(agent) = decision.heading.value
          val velocity = scenario.agents(agent).velocityNed(headings(agent))
          recorder.offer(
            CommandRow(
              sequence,
              decision.vehicle,
              Some(sequence),
              MetresPerSecond(velocity.x),
              MetresPerSecond(velocity.y),
              Metres(-20),
              decided
            )
          )
          pending = pending :+ (decided + roundTrip() / 2, agent, velocity)
          lastSent = lastSent.updated(agent, Some(decided))
        if random.nextInt(40) == 0 then
          recorder.offer(Event(
            now,
            EventKind.Skipped,
            Some("Evader"),
            "an earlier reading was not answered yet"
          ))
      val share = step.toSeconds / 0.8
      velocities =
        agents.map(agent => velocities(agent) + (commanded(agent) - velocities(agent)) * share).toVector
      positions = agents.map(agent => positions(agent) + velocities(agent) * step.toSeconds).toVector
    recorder.recording

  private def decide(
      scenario: Fleet,
      agent: Int,
      sequence: Long,
      readings: Seq[ReadingRow],
      headings: Vector[Double],
      decided: Instant,
      lastSent: Vector[Option[Instant]]
  ): DecisionRow =
    val other   = 1 - agent
    val away    = readings(other).state.value.positionNed - readings(agent).state.value.positionNed
    val closing = readings(other).state.value.velocityNed - readings(agent).state.value.velocityNed
    val elapsed = lastSent(agent).fold(Span.Zero)(decided.since)
    val self    = scenario.agents(agent)
    val heading =
      self.policy.asInstanceOf[HeadingPolicy].heading(
        away.x,
        away.y,
        closing.x,
        closing.y,
        headings(agent),
        headings(other),
        elapsed.toSeconds
      )
    DecisionRow(
      sequence,
      self.name,
      decided,
      readings(agent),
      readings(other),
      Metres(away.x),
      Metres(away.y),
      Radians(headings(agent)),
      Radians(headings(other)),
      Radians(heading),
      elapsed,
      Observations(
        readings(agent).state.ageByArrival(decided),
        readings(other).state.ageByArrival(decided),
        lastSent(agent).map(decided.since),
        lastSent(other).map(decided.since)
      ),
      Some(
        TrueAge(
          decided.since(readings(agent).state.validAt) - offset,
          decided.since(readings(other).state.validAt) - offset,
          offset,
          Span.ofMillis(1.5)
        )
      )
    )

  private def heading(
      loop: String,
      link: String,
      seed: Long,
      seconds: Int,
      scenario: Fleet
  ): RecordingHeader =
    def vehicle(agent: Agent) =
      VehicleRow(agent.name, agent.role.toString, agent.speed, agent.startPositionNed)
    RecordingHeader(
      FlightRow(
        s"$loop-$link",
        loop,
        link,
        seed,
        Span.ofMillis(100),
        Span.ofSeconds(seconds),
        "virtual",
        Simulator.Other("synthetic"),
        "duel",
        "0.1.0",
        start
      ),
      scenario.agents.map(vehicle)
    )
