package skein.simulator

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.US_ASCII
import java.util.BitSet
import skein.scene.Moment
import skein.units.Vector3

/** A grid of cubes, each empty or not, in the `binvox` format (a header in text, then pairs of value and
  * count, runs of x fastest, then up, then y), as AirSim's `simCreateVoxelGrid` writes it.
  */
private[simulator] object VoxelGrid:

  val LargestCells: Long = 256L * 256 * 256

  /** The number of cells along north, east and up.
    *
    * @param sizeM lengths along north, east and up
    * @return Left says what is wrong with the request
    */
  def cells(sizeM: (Int, Int, Int), edgeM: Float): Either[String, (north: Int, east: Int, up: Int)] =
    def count(lengthM: Int) = if edgeM > 0 then (lengthM / edgeM).toLong else 0L
    val (north, east, up)   = (count(sizeM(0)), count(sizeM(1)), count(sizeM(2)))
    if Seq(north, east, up).exists(count => count < 1 || count > LargestCells) ||
      north * east > LargestCells || north * east * up > LargestCells
    then Left(s"a voxel grid has 1 to $LargestCells cells, not $north x $east x $up")
    else Right((north.toInt, east.toInt, up.toInt))

  /** Computes the file. Cost: some 0.1 s for the most cells and vehicles, too long for the simulation's
    * thread.
    *
    * @return Left says what is wrong with the request
    */
  def render(
      moment: Moment,
      centre: Vector3,
      sizeM: (Int, Int, Int),
      edgeM: Float
  ): Either[String, Array[Byte]] = cells(sizeM, edgeM).map: counts =>
    val (northM, eastM, upM) = sizeM
    val (north, east, up)    = (counts.north, counts.east, counts.up)
    val out                  = ByteArrayOutputStream()
    out.write(
      s"""#binvox 1
           |dim $north $up $east
           |translate ${-northM * 0.5} ${-eastM * 0.5} ${-upM * 0.5}
           |scale ${1.0f / northM}
           |data
           |""".stripMargin.getBytes(US_ASCII)
    )
    // The first cell's centre; up is down's opposite.
    val first = centre - Vector3((north / 2).toDouble, (east / 2).toDouble, -(up / 2).toDouble) * edgeM
    def row(j: Int, k: Int) = north * (k + up * j)
    // Marked body by body: testing every cell against every body could take a minute.
    val flying = BitSet()
    for (least, most) <- moment.bounds do
      val (from, to) = (least - first, most - first)
      for
        j <- near(from.y, to.y, edgeM, east)
        k <- near(-to.z, -from.z, edgeM, up)
      do
        val cells = near(from.x, to.x, edgeM, north)
        if cells.nonEmpty then flying.set(row(j, k) + cells.head, row(j, k) + cells.last + 1)
    for k <- 0 until up if first.z - k * edgeM + edgeM / 2 > 0; j <- 0 until east do
      flying.set(row(j, k), row(j, k) + north)
    val runs = Runs(out)
    runs.add(flying, north * east * up)
    out.toByteArray

  /** The cells of a row that overlap an interval, given relative to the first cell's centre. */
  private def near(least: Double, most: Double, edge: Float, cells: Int): Range =
    val from = math.ceil(least / edge - 0.5).max(0).min(cells.toDouble).toInt
    val to   = math.floor(most / edge + 0.5).max(-1).min(cells.toDouble - 1).toInt
    from to to

  /** Run-length encoding: pairs of a value and its count, at most 255. */
  final private class Runs(out: ByteArrayOutputStream):
    def add(filled: BitSet, cells: Int): Unit =
      var at = 0
      while at < cells do
        val value = filled.get(at)
        val end   = if value then filled.nextClearBit(at) else filled.nextSetBit(at)
        val last  = if end < 0 || end > cells then cells else end
        while at < last do
          val length = (last - at).min(255)
          out.write(if value then 1 else 0)
          out.write(length)
          at += length
