package skein.optimise

import skein.signal.{NormalQuantile, SplitMix64}

/** The covariance matrix adaptation evolution strategy: each generation is drawn from a normal distribution
  * whose mean, size and full covariance follow the better half of the one before.
  *
  * Source of the algorithm and of every constant: N. Hansen, "The CMA Evolution Strategy: A Tutorial",
  * arXiv:1604.00772, figure 6 and table 1, with the weights of the worse half set to zero. `CmaEsSuite` tests
  * that it finds the minima of the sphere, an ellipsoid and Rosenbrock's function.
  *
  * @param population λ, number of candidates in a generation; at least 4
  */
final class CmaEs(dimension: Int, population: Int, seed: Long):
  import CmaEs.*
  require(dimension >= 1, s"dimension must be positive, got $dimension")
  require(population >= 4, s"CMA-ES needs a population of at least 4, got $population")

  private val n       = dimension
  private val parents = population / 2
  private val weights =
    val raw = Array.tabulate(parents)(i => StrictMath.log((population + 1) / 2.0) - StrictMath.log(i + 1))
    raw.map(_ / raw.sum)
  private val effective    = 1 / weights.map(w => w * w).sum                   // μ_eff
  private val pathRate     = (4 + effective / n) / (n + 4 + 2 * effective / n) // c_c
  private val sizePathRate = (effective + 2) / (n + effective + 5)             // c_σ
  private val rankOneRate  = 2 / ((n + 1.3) * (n + 1.3) + effective)           // c_1
  private val rankMuRate   =                                                   // c_μ
    (1 - rankOneRate).min(2 * (0.25 + effective + 1 / effective - 2) / ((n + 2) * (n + 2) + effective))
  private val damping = // d_σ
    1 + 2 * (math.sqrt((effective - 1) / (n + 1)) - 1).max(0) + sizePathRate
  private val normalLength = math.sqrt(n) * (1 - 1 / (4.0 * n) + 1 / (21.0 * n * n)) // E‖N(0, I)‖

  def start(mean: Vector[Double], size: Double): State =
    require(mean.size == n && size > 0, s"a mean of $n numbers and a positive size, got $mean and $size")
    val zeros = Vector.fill(n)(0.0)
    State(0, mean, size, Vector.tabulate(n, n)((i, j) => if i == j then 1.0 else 0.0), zeros, zeros)

  /** Draws the next generation; equal states give equal generations. */
  def sample(state: State): Vector[Vector[Double]] =
    val axes   = Axes(state)
    val source = SplitMix64(SplitMix64.seedOf(seed, state.generation))
    Vector.fill(population):
      val z = Array.fill(n)(NormalQuantile(source.nextDouble().max(1e-15).min(1 - 1e-15)))
      Vector.tabulate(n)(i => state.mean(i) + state.size * axes.stretched(z, i))

  /** The state after a generation.
    *
    * @param samples the result of [[sample]] for `state`
    * @param costs cost of each sample; small is good
    */
  def next(state: State, samples: Vector[Vector[Double]], costs: Vector[Double]): State =
    val axes   = Axes(state)
    val chosen = samples.zip(costs).sortBy(_._2).take(parents).map(_._1)
    val steps  = chosen.map(x => Vector.tabulate(n)(i => (x(i) - state.mean(i)) / state.size))
    val step   = Vector.tabulate(n)(i => weighted(k => steps(k)(i)))

    val sizePath =
      val white = axes.whitened(step)
      val gain  = math.sqrt(sizePathRate * (2 - sizePathRate) * effective)
      Vector.tabulate(n)(i => (1 - sizePathRate) * state.sizePath(i) + gain * white(i))
    val length = math.sqrt(sizePath.map(p => p * p).sum)
    val size   = state.size * StrictMath.exp((sizePathRate / damping * (length / normalLength - 1)).min(1))

    // h_σ: stops the covariance's path while the step size increases fast.
    val settled = math.sqrt(1 - StrictMath.pow(1 - sizePathRate, 2.0 * (state.generation + 1)))
    val moves   = if length / settled < (1.4 + 2.0 / (n + 1)) * normalLength then 1.0 else 0.0
    val path    =
      val gain = moves * math.sqrt(pathRate * (2 - pathRate) * effective)
      Vector.tabulate(n)(i => (1 - pathRate) * state.path(i) + gain * step(i))
    val kept       = 1 - rankOneRate - rankMuRate + rankOneRate * (1 - moves) * pathRate * (2 - pathRate)
    val covariance = Vector.tabulate(n, n): (i, j) =>
      kept * state.covariance(i)(j) + rankOneRate * path(i) * path(j) +
        rankMuRate * weighted(k => steps(k)(i) * steps(k)(j))
    State(
      state.generation + 1,
      Vector.tabulate(n)(i => state.mean(i) + state.size * step(i)),
      size,
      covariance,
      path,
      sizePath
    )

  private def weighted(of: Int => Double): Double =
    var sum = 0.0
    for k <- 0 until parents do sum += weights(k) * of(k)
    sum

object CmaEs:
  /** The tutorial's default of λ for a dimension; noisy objectives need a larger one. */
  def defaultPopulation(dimension: Int): Int = 4 + (3 * StrictMath.log(dimension)).toInt

  /** The state of the search before a generation.
    *
    * @param size σ
    * @param covariance C, row by row
    * @param path p_c, the covariance's evolution path
    * @param sizePath p_σ, the step size's evolution path
    */
  final case class State(
      generation: Int,
      mean: Vector[Double],
      size: Double,
      covariance: Vector[Vector[Double]],
      path: Vector[Double],
      sizePath: Vector[Double]
  ):
    /** The distribution's largest standard deviation along an axis. */
    def spread: Double = size * math.sqrt(covariance.indices.map(i => covariance(i)(i)).max)

  /** Principal axes of the covariance: B and D of C = B·D²·Bᵀ. */
  private final class Axes(state: State):
    private val n       = state.mean.size
    private val eigen   = SymmetricEigen.of(state.covariance.map(_.toArray).toArray)
    private val lengths = eigen.values.map(value => math.sqrt(value.max(1e-30)))

    def stretched(z: Array[Double], i: Int): Double =
      var sum = 0.0
      for k <- 0 until n do sum += eigen.vectors(i)(k) * lengths(k) * z(k)
      sum

    def whitened(y: Vector[Double]): Vector[Double] =
      val along = Array.tabulate(n)(k => (0 until n).map(i => eigen.vectors(i)(k) * y(i)).sum / lengths(k))
      Vector.tabulate(n)(i => (0 until n).map(k => eigen.vectors(i)(k) * along(k)).sum)
