
import django.core.validators
from django.db import migrations, models


class Migration(migrations.Migration):

    dependencies = [
        ('gtm_hit', '0002_access'),
    ]

    operations = [
        migrations.AlterField(
            model_name='dataset',
            name='cylinder_height',
            field=models.FloatField(default=1.8, help_text='metres', validators=[django.core.validators.MinValueValidator(0.01), django.core.validators.MaxValueValidator(10)]),
        ),
        migrations.AlterField(
            model_name='dataset',
            name='cylinder_radius',
            field=models.FloatField(default=0.16, help_text='metres', validators=[django.core.validators.MinValueValidator(0.01), django.core.validators.MaxValueValidator(10)]),
        ),
        migrations.AlterField(
            model_name='dataset',
            name='frame_rate',
            field=models.FloatField(default=10.0, help_text='frame numbers per second', validators=[django.core.validators.MinValueValidator(0.001), django.core.validators.MaxValueValidator(1000)]),
        ),
        migrations.AlterField(
            model_name='dataset',
            name='origin_x',
            field=models.FloatField(default=-3.0, help_text='metres', validators=[django.core.validators.MinValueValidator(-1000000.0), django.core.validators.MaxValueValidator(1000000.0)]),
        ),
        migrations.AlterField(
            model_name='dataset',
            name='origin_y',
            field=models.FloatField(default=-9.0, help_text='metres', validators=[django.core.validators.MinValueValidator(-1000000.0), django.core.validators.MaxValueValidator(1000000.0)]),
        ),
        migrations.AlterField(
            model_name='dataset',
            name='step',
            field=models.FloatField(default=0.025, help_text='metres between neighbouring positions', validators=[django.core.validators.MinValueValidator(0.001), django.core.validators.MaxValueValidator(100)]),
        ),
    ]
