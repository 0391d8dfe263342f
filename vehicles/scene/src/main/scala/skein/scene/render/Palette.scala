package skein.scene.render

/** AirSim's table of colours for segmentation ids. */
object Palette:
  private val colours: Array[Int] =
    val text = String(getClass.getResourceAsStream("palette.txt").readAllBytes, "US-ASCII")
    text.linesIterator.filter(_.nonEmpty).map(java.lang.Integer.parseInt(_, 16)).toArray

  def rgb(id: Int): Int = colours(id)
