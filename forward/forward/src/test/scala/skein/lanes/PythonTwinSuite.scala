package skein.lanes

import java.nio.file.{Files, Path}
import skein.forward.*
import skein.lanes.score.Judged
import skein.policy.*
import skein.scenario.*
import skein.signal.{Kinematics, SplitMix64}
import skein.simd.WorldRandom
import skein.testing.Unhurried
import skein.units.*

/** Scenarios written in Python, by the files next to the examples, and equal ones in Scala: equal bits. The
  * package's tests compare the files with the Python.
  */
class PythonTwinSuite extends munit.FunSuite, Unhurried:
  private val root = Iterator
    .iterate(Path.of("").toAbsolutePath)(_.getParent)
    .find(at => Files.exists(at.resolve("sbtw")))
    .get

  private def written(name: String, set: (String, String)*): Scenario =
    val text = Files.readString(root.resolve(s"examples/scenario-in-python/$name.scenario"))
    val kind = ScenarioText.read(text).fold(why => fail(why), identity)
    kind.read(set.toMap).fold(why => fail(why.mkString), identity)

  private val twins: Seq[(String, Scenario, Scenario)] = Seq(
    ("a ring around an evader", written("ring"), Surround()),
    (
      "a wider ring",
      written("ring", "ring-m" -> "11.5", "pursuer-mps" -> "9"),
      Surround(ringM = 11.5, pursuerMps = 9)
    ),
    ("the paper's duel", written("pursuit"), PaperDuel()),
    ("a network's duel", written("network"), NetworkPair.of(root.resolve("examples/scenario-in-python")))
  )

  private val lag   = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val loops = Seq(LoopTiming.Stream(), LoopTiming.Predictive(predictor = lag.predictor))

  private def drawn(random: SplitMix64, self: Int, agents: Vector[Agent]): Observation =
    def within(most: Double) = most * (2 * random.nextDouble() - 1)
    val seen                 = agents.map(_ =>
      Seen(
        Kinematics(
          Vector3(within(30), within(30), -5 + within(1)),
          Vector3(within(8), within(8), within(1)),
          Quaternion.Identity,
          Vector3.Zero
        ),
        Span.ofSeconds(random.nextDouble()),
        isPredicted = false
      )
    )
    Observation(
      self,
      seen,
      Fleet(agents).opponentOf(self, seen(_).kinematics.positionNed),
      agents.map(_ => Radians(within(6))),
      Span.ofSeconds(random.nextDouble()),
      3,
      agents(self).speed,
      Metres(-5)
    )

  for (name, python, scala) <- twins do
    test(s"$name: vehicles are equal, and decide equally, to the bit"):
      val random = SplitMix64(9)
      for ((one, other), self) <- python.agents.zip(scala.agents).zipWithIndex do
        assertEquals(one.copy(policy = other.policy), other)
        for _ <- 1 to 200 do
          val seen = drawn(random, self, scala.agents)
          assertEquals(
            one.policy.choose(seen, one.policy.start)._1,
            other.policy.choose(seen, other.policy.start)._1
          )

    for
      timing     <- loops if !name.contains("wider")
      share      <- Seq(true, false)
      (by, pace) <- Seq("the scalar engine" -> true, "SIMD" -> true, "SIMD, at paces of their own" -> false)
    do
      val isReference = by.startsWith("the scalar")
      test(s"$name, $timing, shared episodes: $share, by $by: equal results"):
        val batch               = TeamBatch(timing, lag, threads = 1, isReference = isReference)
        def flown(of: Scenario) =
          val judged =
            Vector(Judged(Separation, Reduction.Mean, 0), Judged(Separation, Reduction.Least, 2)) ++
              Vector("off ring", "gap").flatMap(name =>
                of.measures.find(_.name == name).flatMap(_.reduced)
              ).map(each =>
                Judged(each.quantity, each.reduction, 3)
              )
          val team   = TeamCandidate(Engagement.of(of.fleet, durationS = 6), judged, areAtOnePace = pace)
          val worlds = new TeamWorlds:
            def size: Int                            = 8
            override def shareEpisodes: Boolean      = share
            def key(world: Int): Int                 = WorldRandom.key(3, 1, if share then 0 else world)
            def link(world: Int): Delays             = DelayTable.vpn
            def candidate(world: Int): TeamCandidate = team
          val engine = batch.engine(team, share, Seq(DelayTable.vpn)).text
          assert(isReference || engine.startsWith("SIMD"), engine)
          batch.fly(worlds).values.map(_.toVector).toVector
        val (one, other) = (flown(python), flown(scala))
        assertEquals(one, other)
