package skein.planning

/** The best manoeuvre found so far, and where to look for better ones. Immutable.
  *
  * @param cost infinite while the manoeuvre was not tried in this situation
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
