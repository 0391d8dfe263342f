package skein.learn

import skein.loop.learning.Transition
import skein.policy.{LearnedPolicy, LearnerSpace, Role}
import skein.signal.SplitMix64

class LearnerInFlightSuite extends munit.FunSuite:
  private val seed     = 20261122L
  private val settings = LearnerSettings(hidden = Vector(8), batch = 16, replay = 1000)
  private val bounds   = Vector(3.0, 0.0)

  private def begun(algorithm: Algorithm, updates: Double = 1, role: Role = Role.Pursuer) =
    LearnerInFlight.of(algorithm, settings, role, LearnerSpace.Level, bounds, updates, 10, seed)(_ =>
      Right(())
    )

  /** Transitions in which turning right brings the opponent nearer. */
  private def transitions(count: Int, nearer: Double = 20): Vector[Transition] =
    val random = SplitMix64(seed)
    Vector.fill(count):
      def seen  = Vector.fill(LearnerSpace.Level.inputs)(random.nextDouble())
      val share = 2 * random.nextDouble() - 1
      Transition(seen, Vector(share), seen, 30 - nearer * share)

  for algorithm <- Seq(Algorithm.Sac, Algorithm.Ddpg) do
    test(
      s"${algorithm.label}: a version follows enough transitions, and equal lessons give equal bits " +
        s"(seed $seed)"
    ):
      def versions =
        val (first, learner) = begun(algorithm).fold(fail(_), identity)
        first +: transitions(60).grouped(4).flatMap(learner.learn(_)).toVector
      val made = versions
      assertEquals(made.size, 7)
      assertEquals(made.distinct.size, 6, "without a whole batch nothing is learned")
      assert(made.forall(_.takeRight(2) == bounds))
      assertEquals(versions, made)

    test(s"${algorithm.label}: a learner learns actions with higher rewards, for either side (seed $seed)"):
      for (role, sign) <- Seq(Role.Pursuer -> 1, Role.Evader -> -1) do
        val (first, learner) = begun(algorithm, updates = 4, role).fold(fail(_), identity)
        val last = transitions(400, nearer = 1000).grouped(20).flatMap(learner.learn(_)).toVector.last
        def mean(weights: Vector[Double]) =
          val policy = LearnedPolicy(LearnedPolicy.shape(settings.hidden), weights.dropRight(2), 3, 0)
          val random = SplitMix64(seed + 1)
          Vector
            .fill(50)(policy.shares(skein.policy.PlanarObservation(
              random.nextDouble(),
              random.nextDouble(),
              random.nextDouble(),
              random.nextDouble(),
              0,
              0.5,
              0.1,
              0.1,
              0.1
            ).fromOwnHeading)(0))
            .sum / 50
        assert(sign * mean(last) > sign * mean(first) + 0.1, s"$role: from ${mean(first)} to ${mean(last)}")

  test("an algorithm that learns only from its newest steps is refused in flight"):
    assert(begun(Algorithm.Ppo).left.exists(_.contains("expected sac or ddpg")))
