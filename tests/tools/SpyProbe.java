// SPDX-License-Identifier: MIT
// A Java agent: writes what lcm-spy's table shows to a file, once a second, a row a line, cells split by tabs; and
// the window as PNG where a second file is named.
import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import java.awt.image.BufferedImage;
import java.io.File;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import javax.imageio.ImageIO;
import javax.swing.JTable;
import javax.swing.SwingUtilities;

class SpyProbe {
  public static void premain(String files) {
    String[] names = files.split(",");
    Thread watch = new Thread(() -> {
      try {
        for (int second = 0; second < 120; ++second) {
          Thread.sleep(1000);
          SwingUtilities.invokeAndWait(() -> look(names));
        }
      } catch (Exception ended) {
        System.err.println("probe: " + ended);
      }
    });
    watch.setDaemon(true);
    watch.start();
  }

  static void look(String[] names) {
    for (Frame frame : Frame.getFrames()) {
      JTable table = table(frame);
      if (table == null) continue;
      StringBuilder text = new StringBuilder();
      for (int row = 0; row < table.getRowCount(); ++row)
        for (int column = 0; column < table.getColumnCount(); ++column)
          text.append(table.getValueAt(row, column)).append(column + 1 < table.getColumnCount() ? "\t" : "\n");
      try {
        Path next = Path.of(names[0] + ".next");
        Files.writeString(next, text);
        Files.move(next, Path.of(names[0]), StandardCopyOption.ATOMIC_MOVE);
        if (names.length > 1) {
          BufferedImage image = new BufferedImage(frame.getWidth(), frame.getHeight(), BufferedImage.TYPE_INT_RGB);
          frame.paint(image.getGraphics());
          ImageIO.write(image, "png", new File(names[1]));
        }
      } catch (java.io.IOException failed) {
        System.err.println("probe: " + failed);
      }
    }
  }

  static JTable table(Component component) {
    if (component instanceof JTable) return (JTable) component;
    if (component instanceof Container)
      for (Component part : ((Container) component).getComponents()) {
        JTable found = table(part);
        if (found != null) return found;
      }
    return null;
  }
}
