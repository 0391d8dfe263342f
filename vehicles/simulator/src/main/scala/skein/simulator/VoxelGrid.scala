package skein.simulator

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.US_ASCII
import java.nio.file.{Files, LinkOption, Path, StandardOpenOption}
import java.util.BitSet
import scala.util.Try
import skein.scene.Moment
import skein.units.Vector3

/** A grid of cubes, each empty or not, in the `binvox` format (a header in text, then pairs of value and
  * count, runs of x fastest, then up, then y), as AirSim's `simCreateVoxelGrid` writes it.
  */
private[simulator] object VoxelGrid:

  /** Cells at most: 256 to each side. */
  val LargestCells: Long = 256L * 256 * 256

  /** @param sizeM lengths along north, east and up
    * @return the file, or what is wrong with the request
    */
  def render(
      moment: Moment,
      centre: Vector3,
      sizeM: (Int, Int, Int),
      edgeM: Float
  ): Either[String, Array[Byte]] =
    val (northM, eastM, upM) = sizeM
    def cells(lengthM: Int)  = if edgeM > 0 then (lengthM / edgeM).toLong else 0L
    val (north, east, up)    = (cells(northM), cells(eastM), cells(upM))
    if Seq(north, east, up).exists(count =>
        count < 1 || count > LargestCells
      ) || north * east > LargestCells ||
      north * east * up > LargestCells
    then Left(s"a voxel grid has 1 to $LargestCells cells, not $north x $east x $up")
    else
      val out = ByteArrayOutputStream()
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
      def index(i: Int, j: Int, k: Int) = i + north.toInt * (k + up.toInt * j)
      // Marked body by body: to ask every cell about every body could take a minute.
      val flying = BitSet()
      for (least, most) <- moment.bounds do
        val (from, to) = (least - first, most - first)
        for
          j <- near(from.y, to.y, edgeM, east)
          k <- near(-to.z, -from.z, edgeM, up)
          i <- near(from.x, to.x, edgeM, north)
        do flying.set(index(i, j, k))
      val runs = Runs(out)
      for j <- 0 until east.toInt; k <- 0 until up.toInt do
        val ground = first.z - k * edgeM + edgeM / 2 > 0
        for i <- 0 until north.toInt do runs.add(ground || flying.get(index(i, j, k)))
      runs.finish()
      Right(out.toByteArray)

  /** The cells of a row that reach into what lies between two places, given from the first one's centre. */
  private def near(least: Double, most: Double, edge: Float, cells: Long): Range =
    val from = math.ceil(least / edge - 0.5).max(0).min(cells.toDouble).toInt
    val to   = math.floor(most / edge + 0.5).max(-1).min(cells.toDouble - 1).toInt
    from to to

  /** Writes a rendered grid, but never over a file that is anything else: the path is a client's. */
  def save(path: String, content: Array[Byte]): Boolean = Try {
    val file = Path.of(path)
    path.endsWith(".binvox") && mayReplace(file) && {
      Files.write(
        file,
        content,
        StandardOpenOption.CREATE,
        StandardOpenOption.TRUNCATE_EXISTING,
        StandardOpenOption.WRITE,
        LinkOption.NOFOLLOW_LINKS
      )
      true
    }
  }.getOrElse(false)

  private val Magic = "#binvox".getBytes(US_ASCII)

  private def mayReplace(file: Path): Boolean =
    !Files.exists(file, LinkOption.NOFOLLOW_LINKS) ||
      Files.isRegularFile(file, LinkOption.NOFOLLOW_LINKS) && {
        val in = Files.newInputStream(file)
        try in.readNBytes(Magic.length).sameElements(Magic)
        finally in.close()
      }

  /** Pairs of a value and how often it comes, 255 times at most. */
  final private class Runs(out: ByteArrayOutputStream):
    private var value  = false
    private var length = 0

    def add(next: Boolean): Unit =
      if next != value || length == 255 then
        finish()
        value = next
      length += 1

    def finish(): Unit =
      if length > 0 then
        out.write(if value then 1 else 0)
        out.write(length)
      length = 0
