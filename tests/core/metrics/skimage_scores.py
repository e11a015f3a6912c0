"""PSNR and SSIM of display values by scikit-image: skimage_scores.py REFERENCE IMAGE WIDTH HEIGHT, where the files hold doubles,
row by row, the three channels of a pixel one after the other. Prints both. Exits with 77 when scikit-image is not there."""
import sys

try:
    import numpy
    from skimage.metrics import peak_signal_noise_ratio, structural_similarity
except ImportError as error:
    print(error)
    sys.exit(77)

width, height = int(sys.argv[3]), int(sys.argv[4])
reference, image = (numpy.fromfile(file, "float64").reshape(height, width, 3) for file in sys.argv[1:3])
print(repr(float(peak_signal_noise_ratio(reference, image, data_range=1))))
print(repr(float(structural_similarity(reference, image, data_range=1, channel_axis=2, gaussian_weights=True, sigma=1.5,
                                       use_sample_covariance=False))))
