package skein.formula

import skein.policy.*
import skein.signal.SplitMix64

/** Every family of policies is a formula, and a formula computes the result of the policy's own method, to
  * the bit.
  */
class PolicyFormulaLaws extends munit.FunSuite:
  private val seed = 20261122L

  private val policies: Seq[(String, SplitMix64 => HeadingPolicy)] =
    PolicyFamily.all.map(family => family.name -> drawn(family)) ++ Seq(
      "keep-heading"               -> (_ => KeepHeading),
      "paper-pursuer as published" -> (_ => PaperPursuer.asPublished),
      "neural, no hidden layer"    -> drawn(PolicyFamily.neural(NeuralShape(Vector.empty))),
      "neural:8x8"                 -> drawn(PolicyFamily.neural(NeuralShape(Vector(8, 8))))
    )

  private def drawn(family: PolicyFamily)(random: SplitMix64): HeadingPolicy =
    family.policy(
      family.space.at(Vector.fill(family.space.dimension)(random.nextDouble()))
    ).asInstanceOf[HeadingPolicy]

  for (name, draw) <- policies do
    test(s"$name: the formula returns the method's result, to the bit (seed $seed)"):
      val random  = SplitMix64(seed)
      val formula = Formula.of(draw(random), "decide").fold(throw _, identity)
      assertEquals(formula.inputs.size, 9)
      for _ <- 1 to 40 do
        val policy = draw(random)
        assert(formula.fits(policy), s"$policy is of another form")
        val parameters = formula.parametersOf(policy)
        for _ <- 1 to 20 do
          def uniform(most: Double) = most * (2 * random.nextDouble() - 1)
          // Now and then exactly nothing, where branches meet.
          def place() = if random.nextDouble() < 0.05 then 0.0 else uniform(25)
          val seen    =
            Array(place(), place(), uniform(12), uniform(12), uniform(10), uniform(10), random.nextDouble())
          val own = policy.heading(seen(0), seen(1), seen(2), seen(3), seen(4), seen(5), seen(6))
          assertEquals(
            java.lang.Double.doubleToRawLongBits(formula.evaluate(seen ++ Array(0.0, 0.0), parameters)(0)),
            java.lang.Double.doubleToRawLongBits(own),
            s"$policy of ${seen.mkString(" ")}"
          )

  for name <- Seq("learned:8x8", "learned:6tanhx5clip:clip", "learned::clip", "climbing:8x8", "climbing:") do
    test(s"$name: the formula of the action returns the method's result, to the bit (seed $seed)"):
      val random   = SplitMix64(seed)
      val family   = PolicyFamily.parse(name).fold(fail(_), identity)
      def policy() =
        val numbers = Vector.fill(family.space.dimension)(random.nextDouble())
        family.policy(family.space.at(numbers)).asInstanceOf[LearnedPolicy]
      val inputs  = policy().space.inputs
      val formula = Formula.of(policy(), "shares", Map("observed" -> inputs)).fold(throw _, identity)
      for _ <- 1 to 40 do
        val drawn    = policy()
        val observed = Array.fill(inputs)(50 * random.nextDouble() - 25)
        assertEquals(
          formula.evaluate(
            observed,
            formula.parametersOf(drawn)
          ).map(java.lang.Double.doubleToRawLongBits).toVector,
          drawn.shares(observed).map(java.lang.Double.doubleToRawLongBits).toVector,
          s"$drawn of ${observed.mkString(" ")}"
        )
