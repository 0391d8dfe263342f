package skein.planning

/** A block of candidate manoeuvres that are drawn, simulated and priced together. Mutable; one per thread.
  * Arrays are ordered by step: the action of candidate i in step h is at h · SIZE + i.
  */
private[planning] abstract class CandidateBlock(steps: Int):
  final val turnRates, speeds: Array[Float] = Array.ofDim(steps * CandidateBlock.Size)

  final val costs: Array[Float] = Array.ofDim(CandidateBlock.Size)

  /** Weighted sums per step and place in the block. */
  final val turnSums, speedSums: Array[Float] = Array.ofDim(steps * CandidateBlock.Size)

  /** Sums of the weights per place in the block. */
  final val weightSums: Array[Float] = Array.ofDim(CandidateBlock.Size)

  /** Sets the situation and the objective of all later manoeuvres. */
  def situate(situation: Situation, objective: PlanCost, dtS: Double): Unit

  /** Draws all candidates, within the limits.
    *
    * @param keys of each candidate's random stream ([[skein.simd.WorldRandom]])
    * @param stepsPerKnot number of steps that share one random number
    */
  def draw(keys: Array[Int], from: SamplingDistribution, limits: CommandLimits, stepsPerKnot: Int): Unit

  def fly(): Unit

  final def forget(): Unit =
    for sums <- Seq(turnSums, speedSums, weightSums) do java.util.Arrays.fill(sums, 0f)

  /** Adds the candidates' actions, each weighted by e^(−(cost − base) / temperature), to the sums. */
  def weigh(base: Float, temperature: Float): Unit

private[planning] object CandidateBlock:
  /** Candidates of a block: few enough for the caches, a multiple of every lane count. */
  final val Size = 128
