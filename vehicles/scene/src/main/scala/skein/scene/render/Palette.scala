package skein.scene.render

/** AirSim's colours of segmentation ids. */
object Palette:
  private val colours: Array[Int] =
    val text = String(getClass.getResourceAsStream("palette.txt").readAllBytes, "US-ASCII")
    text.linesIterator.filter(_.nonEmpty).map(java.lang.Integer.parseInt(_, 16)).toArray

  /** 0xrrggbb of an id from 0 to 255. */
  def rgb(id: Int): Int = colours(id)
