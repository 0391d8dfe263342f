package skein.planning

/** The best manoeuvre found so far, and the distribution of further candidates. Immutable.
  *
  * @param cost infinite if the manoeuvre was not evaluated in this situation
  * @param slices searched so far
  * @param candidates tried so far
  */
final case class Plan(
    manoeuvre: Manoeuvre,
    cost: Float,
    search: SamplingDistribution,
    slices: Int,
    candidates: Long
)
