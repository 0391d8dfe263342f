package skein.scene

/** The AprilTag family 36h11 (Olson, "AprilTag: A robust and flexible visual fiducial system", ICRA 2011):
  * six by six cells, 587 tags, any two of which differ in at least 11 cells in every rotation.
  */
object AprilTag:
  /** Cells of a tag's pattern across: six of data, a black border and a white margin of one each. */
  val Cells = 10

  /** Each tag's cells row by row from the upper left one, as 36 bits from the highest on; a set bit is white.
    */
  private val codes: Array[Long] =
    val text = String(getClass.getResourceAsStream("tag36h11.txt").readAllBytes, "US-ASCII")
    text.trim.split("\\s+").map(java.lang.Long.parseLong(_, 16))

  def count: Int = codes.length

  /** Whether each cell is white, row by row from the upper left, margin and border included. */
  private[scene] def pattern(number: Int): Array[Boolean] =
    Array.tabulate(Cells * Cells): i =>
      val (row, column)     = (i / Cells, i % Cells)
      def within(edge: Int) = Seq(row, column).forall(at => at >= edge && at < Cells - edge)
      if within(2) then (codes(number) >>> (35 - (row - 2) * 6 - (column - 2)) & 1) == 1 else !within(1)
